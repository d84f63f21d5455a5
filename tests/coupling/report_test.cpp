#include "coupling/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/write_file.hpp"
#include "coupling/report/bed_viewer.hpp"
#include "coupling/report/colour_map.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/ledger_checks.hpp"
#include "coupling/report/svg_map.hpp"
#include "coupling/report/svg_plot.hpp"
#include "coupling/report/svg_scatter.hpp"
#include "sample_run.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;

class ReportTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    add_pictures(run_, folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string written() {
    write_report(folder_, run_.checked, run_.record, run_.bed, run_.part, run_.extras);
    return read_file(folder_ / "report.html");
  }
  std::string header(std::string const& csv) {
    std::ifstream file(folder_ / csv);
    std::string line;
    std::getline(file, line);
    return line;
  }

  fs::path folder_ = fs::temp_directory_path() /
                     ("report_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  SampleRun run_ = sample_run();
};

bool holds(std::string const& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST_F(ReportTest, words_of_the_user_cannot_become_markup) {
  std::string const html = written();
  EXPECT_FALSE(holds(html, "<script>alert"));
  EXPECT_TRUE(holds(html, "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; {{style}}"));
  EXPECT_TRUE(holds(html, "the blade &lt;b&gt;touches&lt;/b&gt;"));
  EXPECT_TRUE(holds(html, "grains &quot;from&quot; &lt;above&gt;"));
  EXPECT_TRUE(holds(html, "a &lt;i&gt;sentence&lt;/i&gt; &amp; &quot;quotes&quot;"));
}

TEST_F(ReportTest, same_input_same_bytes) { EXPECT_TRUE(written() == written()); }

TEST_F(ReportTest, pictures_are_inside_the_page) {
  EXPECT_TRUE(holds(written(), "data:image/png;base64," + base64(read_file(folder_ / "bed_0001.png"))));
}

TEST_F(ReportTest, a_picture_from_elsewhere_is_refused) {
  run_.record.layers[0].pictures = {{"../secret.png", ""}};
  EXPECT_THROW(written(), FileError);
  run_.record.layers[0].pictures = {{"missing.png", ""}};
  EXPECT_THROW(written(), FileError);
}

TEST_F(ReportTest, every_plot_has_its_numbers_beside_it) {
  std::string const html = written();
  EXPECT_EQ(header("profiles.csv"),
            "layer,x [um],relative_density,effective_thickness [um],mean_diameter [um],grains,real_effective_thickness "
            "[um],volume_fraction_nominal,surface_coverage,roughness_sa [um],d50 [um],coordination_number");
  EXPECT_EQ(header("surface_0001.csv"), "x [um],y [um],surface [um]");
  EXPECT_EQ(header("absorbed_energy_0002.csv"), "x [um],y [um],absorbed_energy [J/mm2]");
  EXPECT_EQ(header("part_surface_0002.csv"), "x [um],y [um],height_above_plate [um]");
  EXPECT_EQ(header("size_distribution.csv"), "diameter [um],fed_number_share,bed_number_share,plate_number_share");
  EXPECT_TRUE(header("sections.csv").starts_with("layer,x [um],y [um],z [um],peak_temperature [K],"));
  EXPECT_TRUE(header("layers.csv").starts_with("layer,grains,effective_thickness [um],"));
  for (std::size_t at = 0; (at = html.find("class=\"numbers\" href=\"", at)) != std::string::npos;) {
    at += std::string_view("class=\"numbers\" href=\"").size();
    EXPECT_TRUE(fs::exists(folder_ / html.substr(at, html.find('"', at) - at)));
  }
}

TEST_F(ReportTest, csv_holds_the_numbers_of_the_record) {
  written();
  std::string const sizes = read_file(folder_ / "size_distribution.csv");
  EXPECT_TRUE(holds(sizes, "\n13,0.25,0.333333333,0.5\n28,0.75,0.666666667,0.5\n")) << sizes;
  // Pixel (0, 0) has its centre half a pixel in; the plate of layer 1 lies at -60 um, the surface at -30.
  EXPECT_TRUE(holds(read_file(folder_ / "part_surface_0001.csv"), "\n105,5,30\n"));
  EXPECT_TRUE(holds(read_file(folder_ / "absorbed_energy_0001.csv"), "\n105,5,1.5\n"));
  EXPECT_TRUE(holds(read_file(folder_ / "sections.csv"), "\n1,150,25,-85,2500,1,1\n"));
}

TEST_F(ReportTest, frozen_zone_shows_no_laser) {
  run_.checked.machine.frozen_zone = {120e-6, 180e-6};
  std::string const html = written();
  EXPECT_FALSE(holds(html, "Absorptivity"));
  EXPECT_FALSE(holds(html, "Where the light went"));
  EXPECT_FALSE(fs::exists(folder_ / "sections.csv"));
}

TEST_F(ReportTest, long_runs_show_a_choice_of_layers) {
  run_.record.layers.clear();
  for (int n = 1; n <= 40; ++n) run_.record.layers.push_back(sample_layer(n));
  EXPECT_TRUE(holds(written(), "Pictures and maps of 6 of the 40 layers"));
  EXPECT_TRUE(fs::exists(folder_ / "surface_0001.csv") && fs::exists(folder_ / "surface_0040.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "surface_0002.csv"));
}

TEST_F(ReportTest, bare_run_is_a_report_too) {
  // No grains, no mesh, empty maps, nothing melted.
  run_.bed = {};
  run_.part = {};
  run_.record.layers = {LayerRecord{}};
  run_.record.layers[0].layer = 1;
  EXPECT_TRUE(holds(written(), "</html>"));
}

TEST(Html, base64_of_rfc_4648) {
  // The test vectors of RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Html, numbers_for_people) {
  EXPECT_EQ(significant(0.04123), "0.0412");
  EXPECT_EQ(significant(9.996), "10.0");
  EXPECT_EQ(significant(-1834.4), "&minus;1834");
  EXPECT_EQ(significant(0), "0");
  EXPECT_EQ(significant(std::nan("")), "&ndash;");
  EXPECT_TRUE(holds(significant(2.13e-9, 2), "2.1 &times; 10<sup>-9</sup>"));
  EXPECT_TRUE(with_uncertainty(0.61234, 0.0043).starts_with("0.6123 "));
  EXPECT_EQ(with_uncertainty(0.61234, 0), "0.612");
  EXPECT_EQ(count(1234567), "1&#8239;234&#8239;567");
  EXPECT_EQ(count(-123), "-123");
}

TEST(Html, filling_in_does_not_search_what_it_filled_in) {
  EXPECT_EQ(fill_in("<{{a}}|{{b}}|{{a}}>", {{"a", "{{b}}"}, {"b", "2"}}), "<{{b}}|2|{{b}}>");
}

TEST(Plot, ticks_are_round_and_inside) {
  for (double const low : {-3.7e-5, 0.0, 0.0123, 980.0}) {
    for (double const span : {1e-6, 0.5, 7.0, 1234.0}) {
      Ticks const ticks = round_ticks(low, low + span, 5);
      ASSERT_GE(ticks.at.size(), 2u) << low << ' ' << span;
      ASSERT_LE(ticks.at.size(), 12u);
      EXPECT_GE(ticks.at.front(), low - 1e-9 * span);
      EXPECT_LE(ticks.at.back(), low + span + 1e-9 * span);
    }
  }
  EXPECT_EQ(round_ticks(0.9, 2.1, 5, true).at, (std::vector<double>{1, 2}));
  EXPECT_EQ(round_ticks(0, 1, 5).label(0.2), "0.2");
}

TEST(Plot, what_is_zero_everywhere_is_a_level_line) {
  std::string const plot =
      line_plot({.x_label = "x", .y_label = "y", .series = {{.name = "flat", .x = {1, 2}, .y = {0, 0}}}});
  EXPECT_TRUE(holds(plot, ">0.5<") && holds(plot,
                                            ">\xe2\x88\x92"
                                            "0.5<"))
      << plot;
}

TEST(Plot, map_stays_where_its_cells_are) {
  Raster const map{.x0 = 10, .y0 = -5, .cell = 2, .nx = 3, .ny = 2, .values = {1, 2, 3, 4, 5, 6}};
  Raster const part = crop(map, 1, 9, -4, 1);
  EXPECT_EQ(part.x0, 12);
  EXPECT_EQ(part.y0, -5);
  EXPECT_EQ(part.values, (std::vector<double>{2, 3}));
}

TEST(Plot, quantiles_of_finite_values) {
  EXPECT_EQ(quantiles({5, std::nan(""), 1, 3, 2, 4}, {0, 0.5, 1}), (std::vector<double>{1, 3, 5}));
}

TEST(Colour, maps_grow_lighter) {
  for (ColourMap const map : {ColourMap::height, ColourMap::heat}) {
    double before = -1;
    for (int i = 0; i <= 50; ++i) {
      auto const rgb = colour(map, i / 50.0);
      double const lightness = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
      EXPECT_GT(lightness, before);
      before = lightness;
    }
  }
  EXPECT_EQ(hex_colour(colour(ColourMap::height, 0)), "#440154");  // viridis begins there
  EXPECT_EQ(hex_colour(colour(ColourMap::heat, 1)), "#fdf2b5");
}

TEST(BedViewer, shows_no_more_than_a_page_can_hold) {
  PowderBed bed;
  std::size_t const grains = viewer_grain_limit + 500;
  for (std::size_t i = 0; i < grains; ++i)
    bed.add(static_cast<std::int64_t>(i), Vec3(1e-8 * static_cast<double>(i), 0, 0), 1e-5, 0);
  TriangleSurface part;
  part.vertices = {Vec3(0, 0, 0), Vec3(2e-5, 0, 0), Vec3(0, 1e-5, 0)};  // its middle lies near the first grains
  part.triangles.assign(viewer_triangle_limit + 1, {0, 1, 2});
  auto const data = nlohmann::json::parse(viewer_data(bed, part, 0));
  EXPECT_EQ(data["grains"], viewer_grain_limit);
  EXPECT_EQ(data["all_grains"], grains);
  EXPECT_EQ(data["triangles"], 0);
  EXPECT_EQ(data["all_triangles"], part.triangles.size());
  // The farthest grains are those that are left out.
  EXPECT_NEAR(data["size"][0].get<double>(), 1e-2 * static_cast<double>(viewer_grain_limit - 1), 1e-6);
}

TEST(LedgerChecks, an_open_ledger_is_seen) {
  auto const holding = [](Ledger const& ledger) {
    auto const checks = ledger_checks(ledger, true);
    return std::count_if(checks.begin(), checks.end(), [](LedgerCheck const& check) { return check.holds; });
  };
  Ledger good;
  good.particles_fed = 10, good.particles_bed = 7, good.particles_overflow = 1, good.particles_melted = 2;
  good.power_incident = 100;
  EXPECT_EQ(holding(good), 5);
  Ledger booked = good;
  booked.energy_work_done = 1e-9;
  EXPECT_EQ(holding(booked), 6);
  booked.energy_relative_error_dem = 2e-3;
  EXPECT_EQ(holding(booked), 5);
  Ledger bad = good;
  bad.particles_bed = 6;
  EXPECT_EQ(holding(bad), 4);
  bad.particles_lost = 1;
  EXPECT_EQ(holding(bad), 5) << "drawn away, and booked";
  bad = good;
  bad.power_residual = 2e-4;
  EXPECT_EQ(holding(bad), 4);
  bad = good;
  bad.mass_relative_error = std::nan("");
  EXPECT_EQ(holding(bad), 4);
}

std::size_t count_of(std::string const& text, std::string_view part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++n;
  return n;
}

TEST(SvgScatter, draws_what_is_finite_and_keeps_to_the_style_sheet) {
  double const nan = std::nan("");
  ScatterPlot const plot{.x_label = "measured <um>",
                         .y_label = "model",
                         .series = {{.name = "a & b", .x = {1, 2, nan}, .y = {1, 3, 2}, .y_error = {0.5, 0, 1}},
                                    {.name = "c", .x = {1.5}, .y = {nan}}},
                         .diagonal = Diagonal::drawn};
  std::string const drawn = scatter_plot(plot);
  EXPECT_EQ(count_of(drawn, "r=\"3.2\""), 2U);
  EXPECT_EQ(count_of(drawn, "class=\"error\""), 1U);
  EXPECT_TRUE(holds(drawn, "measured &lt;um&gt;") && holds(drawn, "a &amp; b"));
  std::string const table = square_matrix({"x", "y"}, {1, -0.4, -0.4, 1}, "cosines");
  EXPECT_EQ(count_of(table, "<rect"), 4U);
  EXPECT_TRUE(holds(table, ">-40</text>"));
  std::string const bars = lying_bars({.x_label = "z", .bars = {{.name = "keyhole", .value = 4, .error = 1}}});
  std::string const map = coloured_points(
      {.x_label = "P", .y_label = "v", .value_label = "z", .x = {1, 2}, .y = {1, nan}, .value = {4, 1}});
  EXPECT_EQ(count_of(map, "class=\"signed\""), 5U + 1U);
  for (std::string const& text : {drawn, table, bars, map}) EXPECT_FALSE(holds(text, "style="));
}

}  // namespace
}  // namespace layerloop::coupling
