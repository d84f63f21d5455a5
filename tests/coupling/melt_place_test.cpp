// What the verb melt makes of places, times and temperatures without computing heat.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/error.hpp"
#include "core/write_file.hpp"
#include "coupling/fusion.hpp"
#include "coupling/melt_bed.hpp"
#include "coupling/melt_study.hpp"
#include "coupling/scan_file.hpp"
#include "coupling/scan_path.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;

Case patch_case() {
  Case checked;
  checked.machine.deposition_length = 600e-6;
  checked.machine.width = 600e-6;
  checked.laser.power = 100;
  checked.scan.kind = ScanKind::hatch;
  checked.scan.scan_speed = 0.5;
  checked.scan.track_length = 300e-6;
  checked.scan.tracks = 3;
  checked.scan.hatch_spacing = 80e-6;
  checked.scan.dwell = 1e-4;
  return checked;
}

TEST(ScanPath, TurnsAboutTheMiddleByAnyAngle) {
  Case checked = patch_case();
  checked.scan.rotation = 67 * std::numbers::pi / 180;
  std::vector<Track> const first = scan_path(checked, 1), second = scan_path(checked, 2);
  double const c = std::cos(checked.scan.rotation), s = std::sin(checked.scan.rotation);
  for (std::size_t t = 0; t < 3; ++t) {
    Vec3 const from = first[t].begin - Vec3(300e-6, 300e-6, 0), to = second[t].begin - Vec3(300e-6, 300e-6, 0);
    EXPECT_NEAR(to.x(), c * from.x() - s * from.y(), 1e-15);
    EXPECT_NEAR(to.y(), s * from.x() + c * from.y(), 1e-15);
  }
}

TEST(ScanPath, OrderOfTheTracksIsThatOfTheIndex) {
  Case checked = patch_case();
  std::vector<Track> const plain = scan_path(checked, 1);
  checked.scan.track_index = {1, 3, 2};
  std::vector<Track> const skipping = scan_path(checked, 1);
  EXPECT_EQ(skipping[1].begin.y(), plain[2].begin.y());
  EXPECT_EQ(skipping[2].begin.y(), plain[1].begin.y());
  EXPECT_GT(skipping[1].begin.x(), skipping[1].end.x()) << "every second one runs backwards";
  EXPECT_EQ(skipping[2].begin_time, plain[2].begin_time);
}

/// To and fro: the middle of a track is passed half a track after the turn, and half a track after that of the one
/// before: a whole track and a dwell.
TEST(ScanPath, ReturnTimeOfAHatchIsATrackAndADwell) {
  std::vector<std::optional<double>> const times = return_times(scan_path(patch_case(), 1));
  EXPECT_FALSE(times[0]);
  EXPECT_NEAR(*times[1], 300e-6 / 0.5 + 1e-4, 1e-15);
  EXPECT_NEAR(*times[2], 300e-6 / 0.5 + 1e-4, 1e-15);
}

struct WayFile {
  fs::path path = fs::temp_directory_path() / "layerloop_way_test.csv";
  explicit WayFile(std::string const& rows, std::string const& last = "speed [mm/s]") {
    write_file(path, "x [um],y [um],power [W]," + last + "\n" + rows);
  }
  ~WayFile() { fs::remove(path); }
  std::string fault() const {
    try {
      read_scan_file(path);
    } catch (InputError const& error) {
      return error.what();
    }
    return "";
  }
};

TEST(ScanFile, PointsWithSpeedsAndWithTimes) {
  std::vector<Track> const by_speed =
      read_scan_file(WayFile("0,0,0,0\n300,0,100,500\n300,80,0,1600\n0,80,90,500\n").path);
  ASSERT_EQ(by_speed.size(), 2U);
  EXPECT_NEAR(by_speed[1].begin_time, 300e-6 / 0.5 + 80e-6 / 1.6, 1e-18);
  EXPECT_EQ(by_speed[1].power, 90);
  EXPECT_NEAR(by_speed[1].end_time - by_speed[1].begin_time, 600e-6, 1e-18);
  std::vector<Track> const by_time = read_scan_file(WayFile("0,0,0,100\n300,0,100,700\n", "time [us]").path);
  ASSERT_EQ(by_time.size(), 1U);
  EXPECT_EQ(by_time[0].begin_time, 0);
  EXPECT_NEAR(by_time[0].end_time, 600e-6, 1e-18);
}

TEST(ScanFile, NamesTheLineThatIsWrong) {
  EXPECT_NE(WayFile("0,0,0,500\n300,0,100\n").fault().find(":3: 3 values"), std::string::npos);
  EXPECT_NE(WayFile("0,0,0,500\n300,0,-5,500\n").fault().find(":3: power"), std::string::npos);
  EXPECT_NE(WayFile("0,0,0,500\n300,0,100,0\n").fault().find(":3: speed"), std::string::npos);
  EXPECT_NE(WayFile("0,0,0,500\n0,0,100,500\n").fault().find(":3: the beam is on without moving"), std::string::npos);
  EXPECT_NE(WayFile("0,0,0,500\n300,0,0,500\n").fault().find("never on"), std::string::npos);
  EXPECT_NE(WayFile("0,0,0,9\n300,0,100,700\n400,0,100,600\n", "time [us]").fault().find(":4: time"),
            std::string::npos);
  EXPECT_NE(WayFile("0,0,0,500\n", "speed").fault().find(":1: header"), std::string::npos);
}

TEST(ScanFile, WayThatLeavesTheBedIsRefused) {
  WayFile const file("-400,0,0,500\n300,0,100,500\n");
  Case checked = patch_case();
  checked.scan.kind = ScanKind::file;
  checked.scan.path = file.path.string();
  EXPECT_THROW(scan_path(checked, 1), InputError);
  checked.machine.deposition_length = 900e-6;
  EXPECT_NO_THROW(scan_path(checked, 1));
}

/// Half ellipses of 90 um width and 40 um depth, drawn into the cells as temperatures that fall linearly outwards.
struct DrawnPatch {
  CellContent content;
  MeltRecord melt;
  std::vector<Track> tracks;
  static constexpr double cell = 2e-6, width = 90e-6, depth = 40e-6, isotherm = 1700;

  explicit DrawnPatch(double hatch) {
    VoxelGrid& grid = content.grid;
    grid = {Vec3(0, 0, -40 * cell), cell, {30, 200, 40}};
    melt.grid = grid;
    auto const n = static_cast<std::size_t>(grid.size());
    content.solid.assign(n, 1), content.powder.assign(n, 0), content.grain.assign(n, -1);
    melt.pool = {width, depth, 0};
    for (int t : {-1, 0, 1}) {
      double const y = 200e-6 + t * hatch;
      tracks.push_back({{0, y, 0}, {60e-6, y, 0}, 0, 1, 1});
    }
    for (std::int64_t c = 0; c < grid.size(); ++c) {
      auto const at = grid.coordinates(c);
      Vec3 const p = grid.centre(at[0], at[1], at[2]);
      double inside = 1e9;
      for (Track const& track : tracks)
        inside = std::min(inside, std::hypot(2 * (p.y() - track.begin.y()) / width, p.z() / depth));
      melt.peak_temperature.push_back(static_cast<float>(isotherm * (2 - inside)));
      melt.melted.push_back(inside <= 1);
    }
  }
  Fusion fusion() const { return fusion_of(melt, content, tracks, isotherm).value(); }
};

TEST(Fusion, EllipsesThatDoNotMeetLeaveTheRestOfTheHatch) {
  Fusion const fusion = DrawnPatch(120e-6).fusion();
  EXPECT_NEAR(fusion.unmelted_surface, 1 - 90.0 / 120, 0.02);
  EXPECT_EQ(fusion.overlap_depth, 0);
  EXPECT_EQ(fusion.elliptic_overlap_depth, 0);
  EXPECT_FALSE(fusion.unmelted_powder);
}

/// Tang et al.: the depth L at which two ellipses meet is given by (H / W)^2 + (L / D)^2 = 1.
TEST(Fusion, EllipsesThatMeetDoSoAtTheDepthOfTheCriterion) {
  double const expected = 40e-6 * std::sqrt(1 - std::pow(60.0 / 90, 2));
  Fusion const fusion = DrawnPatch(60e-6).fusion();
  EXPECT_EQ(fusion.unmelted_surface, 0);
  EXPECT_NEAR(fusion.elliptic_overlap_depth, expected, 1e-12);
  EXPECT_NEAR(fusion.overlap_depth, expected, 1.5e-6);
}

TEST(Regime, FollowsWhatMeltsAndBoils) {
  RegimeSigns signs{.pool = {100e-6, 30e-6, 250e-6}, .spot_radius = 40e-6, .molten = true};
  EXPECT_EQ(regime_of({}), Regime::none);
  EXPECT_EQ(regime_of(signs), Regime::conduction);
  signs.boils = true, signs.depression = 10e-6;
  EXPECT_EQ(regime_of(signs), Regime::transition);
  signs.depression = 50e-6;
  EXPECT_EQ(regime_of(signs), Regime::keyhole);
  signs.powder = true, signs.pool.depth = 0;
  EXPECT_EQ(regime_of(signs), Regime::no_fusion);
  signs.pool.depth = 5e-6, signs.height = 30e-6, signs.pool.length = 400e-6;
  EXPECT_EQ(regime_of(signs), Regime::balling);
  signs.pool.depth = 60e-6;
  EXPECT_EQ(regime_of(signs), Regime::keyhole) << "what is anchored deeper than it stands does not ball";
}

/// T = 300 + 2000 exp(-t / tau) passes from 1600 to 1500 K in tau ln(1300 / 1200).
TEST(CoolingRate, OfAnExponential) {
  ProbeHistory probe;
  double const tau = 1e-4;
  for (int i = 0; i < 3000; ++i) {
    probe.time.push_back(i * 1e-7);
    probe.temperature.push_back(300 + 2000 * std::exp(-probe.time.back() / tau));
  }
  auto const rate = cooling_rate(probe, 1600);
  ASSERT_TRUE(rate);
  double const expected = 100 / (tau * std::log(1300.0 / 1200));
  EXPECT_NEAR(rate->value, expected, 1e-5 * expected);
  EXPECT_NEAR(rate->u_num, expected * std::sqrt(0.5) * 1e-7 / (tau * std::log(1300.0 / 1200)), 0.01 * rate->u_num);
  EXPECT_FALSE(cooling_rate(probe, 390)) << "it never was so cold";
}

}  // namespace
}  // namespace layerloop::coupling
