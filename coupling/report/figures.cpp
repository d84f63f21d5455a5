#include "coupling/report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/write_file.hpp"
#include "coupling/report/csv_tables.hpp"
#include "coupling/report/html.hpp"
#include "coupling/report/svg_map.hpp"
#include "coupling/report/svg_plot.hpp"

namespace layerloop::coupling {
namespace {

constexpr double page_width = 1140, half_width = 560, third_width = 420;

std::string csv_name(std::string_view name, LayerRecord const& layer) {
  return fmt::format("{}_{:04}.csv", name, layer.layer);
}

/// Figures side by side, as many as the page has room for: small ones, or large ones in pairs.
std::string grid(std::string const& figures) {
  return figures.empty() ? "" : "<div class=\"grid\">" + figures + "</div>\n";
}
std::string pairs(std::string const& figures) {
  return figures.empty() ? "" : "<div class=\"pairs\">" + figures + "</div>\n";
}

/// Long maps take the whole width of the page, others stand in pairs.
double map_width(Raster const& map) { return map.nx > 3.5 * map.ny ? page_width : half_width; }

Raster raster_of(AreaMap const& map, double scale, double offset) {
  Raster raster{1e6 * map.x0, 1e6 * map.y0, 1e6 * map.spacing, map.nx, map.ny, map.values};
  for (double& value : raster.values) value = scale * value + offset;
  return raster;
}

/// Range of colours that all maps of one kind share, without the outermost values.
ColourScale common_scale(std::vector<Raster> const& maps, ColourMap colours, std::string label,
                         std::vector<double> const& shares) {
  std::vector<double> all;
  for (Raster const& map : maps) all.insert(all.end(), map.values.begin(), map.values.end());
  std::vector<double> const range = quantiles(std::move(all), shares);
  return {colours, std::move(label), range[0], range[1] > range[0] ? range[1] : range[0] + 1};
}

struct CellRange {
  int i0 = std::numeric_limits<int>::max(), i1 = 0, j0 = i0, j1 = 0;
  void add(int i, int j) {
    i0 = std::min(i0, i), i1 = std::max(i1, i + 1);
    j0 = std::min(j0, j), j1 = std::max(j1, j + 1);
  }
  bool empty() const { return i1 == 0; }
};

template <class Test>
CellRange cells_where(int nx, int ny, Test test) {
  CellRange range;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      if (test(i, j)) range.add(i, j);
  return range;
}

/// The lit part of an energy map and a margin.
Raster lit_part(Raster const& map) {
  double const brightest = map.values.empty() ? 0 : *std::max_element(map.values.begin(), map.values.end());
  CellRange const lit = cells_where(map.nx, map.ny, [&](int i, int j) { return map.at(i, j) > 0.01 * brightest; });
  if (lit.empty()) return map;
  int const margin = 8;
  return crop(map, lit.i0 - margin, lit.i1 + margin, lit.j0 - margin, lit.j1 + margin);
}

std::string section_figure(LayerRecord const& layer, MeltSection const& section, ColourScale const& scale) {
  auto const state = [&](int j, int k) {
    return section.state[static_cast<std::size_t>(j + std::int64_t{section.ny} * k)];
  };
  auto const melted = [&](int j, int k) { return state(j, k) >= 4; };
  auto const before = [&](int j, int k, int what) { return (state(j, k) & 3) == what; };
  Raster raster{1e6 * section.y0, 1e6 * section.z0, 1e6 * section.cell, section.ny, section.nz, {}};
  for (std::size_t cell = 0; cell < section.state.size(); ++cell)
    raster.values.push_back(section.state[cell] == 0 ? std::nan("")
                                                     : static_cast<double>(section.peak_temperature[cell]));

  CellRange const pool = cells_where(section.ny, section.nz, melted);
  CellRange const matter = cells_where(section.ny, section.nz, [&](int j, int k) { return state(j, k) != 0; });
  CellRange const view = pool.empty() ? matter : pool;
  int const margin = 10;
  int const j0 = std::max(0, view.i0 - margin), k0 = std::max(0, view.j0 - 5);
  Raster const shown = crop(raster, j0, view.i1 + margin, k0, std::max(matter.j1, view.j1) + 3);
  std::vector<Outline> const outlines{
      {[&](int j, int k) { return before(j + j0, k + k0, 1); }, "outline-powder"},
      {[&](int j, int k) { return before(j + j0, k + k0, 2); }, "outline-solid"},
      {[&](int j, int k) { return melted(j + j0, k + k0); }, "outline-melted"},
  };
  std::string const plot = map_plot(shown, scale, "y [\xc2\xb5m]", "z [\xc2\xb5m]", outlines, third_width);
  return figure(
      plot,
      fmt::format("<b>Layer {}</b>, cut at x = {} &micro;m.", layer.layer, chosen(std::round(1e7 * section.x) / 10)),
      "sections.csv");
}

std::string profiles(ReportInput const& input) {
  std::vector<Series> density, thickness, diameter;
  for (LayerRecord const* layer : input.shown) {
    Series const empty{.name = fmt::format("layer {}", layer->layer), .x = {}, .y = {}};
    density.push_back(empty), thickness.push_back(empty), diameter.push_back(empty);
    for (LayerBin const& bin : layer->metrics.bins) {
      for (auto* plot : {&density, &thickness, &diameter}) plot->back().x.push_back(1e6 * bin.x);
      density.back().y.push_back(bin.volume_fraction_real);
      thickness.back().y.push_back(1e6 * bin.effective_thickness);
      diameter.back().y.push_back(1e6 * bin.mean_diameter);
    }
  }
  std::string const x = "x [\xc2\xb5m]";
  auto const plot = [&](std::string const& label, std::vector<Series> series, std::string_view caption) {
    return figure(
        line_plot({.x_label = x, .y_label = label, .series = std::move(series), .width = half_width, .height = 290}),
        caption, "profiles.csv");
  };
  return plot("relative density", std::move(density), "How densely the layer lies along the way of the blade.") +
         plot("effective thickness [\xc2\xb5m]", std::move(thickness),
              "Mean height of the surface over the plane one nominal layer below the blade.") +
         plot("mean diameter [\xc2\xb5m]", std::move(diameter),
              "A slope means that the blade sorts the grains by size.");
}

std::string size_distribution(ReportInput const& input) {
  BarPlot plot{.x_label = "grain diameter [\xc2\xb5m]",
               .y_label = "share by number",
               .categories = {},
               .series = {},
               .width = half_width,
               .height = 290};
  plot.series = {{.name = "as fed", .x = {}, .y = {}},
                 {.name = "whole bed at the end", .x = {}, .y = {}},
                 {.name = "on the plate", .x = {}, .y = {}}};
  for (SizeShares const& s : size_shares(input.checked, input.bed)) {
    plot.categories.push_back(fmt::format("{:.4g}", 1e6 * s.diameter));
    plot.series[0].y.push_back(s.fed);
    plot.series[1].y.push_back(s.bed);
    plot.series[2].y.push_back(s.plate);
  }
  return figure(
      bar_plot(plot),
      "Grain sizes: what the case asks for, all loose grains that are left, and those in the deposition zone.",
      "size_distribution.csv");
}

/// One small plot of quantities over the layers.
std::string trend(std::string const& label, std::vector<Series> series) {
  return figure(line_plot({.x_label = "layer",
                           .y_label = label,
                           .series = std::move(series),
                           .whole_x = true,
                           .width = third_width,
                           .height = 250}),
                "", "layers.csv");
}

template <class Value>
Series over_layers(RunRecord const& record, std::string name, Value value) {
  Series series{.name = std::move(name), .x = {}, .y = {}};
  for (LayerRecord const& layer : record.layers) {
    series.x.push_back(layer.layer);
    series.y.push_back(value(layer));
  }
  return series;
}

template <class Value, class Error>
Series over_layers(RunRecord const& record, std::string name, Value value, Error error) {
  Series series = over_layers(record, std::move(name), value);
  for (LayerRecord const& layer : record.layers) series.error.push_back(error(layer));
  return series;
}

double or_none(double error) { return std::isfinite(error) ? error : 0; }

}  // namespace

std::string bed_pictures(ReportInput const& input) {
  std::string figures;
  for (LayerRecord const* layer : input.shown) {
    for (auto const& [name, caption] : layer->pictures) {
      if (std::filesystem::path(name).filename() != name)
        throw FileError(
            fmt::format("picture \"{}\" cannot be embedded (it must lie in the output folder itself)", name));
      std::string const picture = base64(read_file(input.folder / name));
      figures += figure(fmt::format("<img src=\"data:image/png;base64,{}\" alt=\"{}\">", picture, escape(caption)),
                        fmt::format("<b>Layer {}.</b> {}", layer->layer, escape(caption)));
    }
  }
  return figures.empty() ? "" : "<div class=\"pictures\">" + figures + "</div>\n";
}

std::string surface_maps(ReportInput const& input) {
  std::vector<Raster> maps;
  for (LayerRecord const* layer : input.shown) maps.push_back(raster_of(layer->metrics.surface, 1e6, 0));
  ColourScale const scale = common_scale(maps, ColourMap::height, "surface height [\xc2\xb5m]", {0.01, 0.998});
  std::string figures;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    if (maps[k].values.empty()) continue;
    LayerRecord const& layer = *input.shown[k];
    double const plate = -1e6 * input.checked.machine.layer_thickness * layer.layer;
    figures += figure(
        map_plot(maps[k], scale, "x along the recoating direction [\xc2\xb5m]", "y [\xc2\xb5m]", {},
                 map_width(maps[k])),
        fmt::format("<b>Layer {}</b> after spreading; 0 is the level of the platforms, the plate lies at {} &micro;m.",
                    layer.layer, chosen(plate)),
        csv_name("surface", layer));
  }
  return pairs(figures);
}

std::string profiles_and_sizes(ReportInput const& input) { return pairs(profiles(input) + size_distribution(input)); }

std::string energy_maps(ReportInput const& input) {
  std::vector<Raster> maps;
  for (LayerRecord const* layer : input.shown) maps.push_back(lit_part(raster_of(layer->absorbed_energy, 1e-6, 0)));
  ColourScale scale = common_scale(maps, ColourMap::heat, "absorbed energy [J/mm\xc2\xb2]", {0, 0.998});
  scale.low = 0;
  std::string figures;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    if (maps[k].values.empty()) continue;
    LayerRecord const& layer = *input.shown[k];
    figures += figure(
        map_plot(maps[k], scale, "x [\xc2\xb5m]", "y [\xc2\xb5m]", {}, map_width(maps[k])),
        fmt::format(
            "<b>Layer {}</b>, whole exposure, seen from above: absorptivity {}, {} rays, {} hits on a surface per ray.",
            layer.layer, with_uncertainty(layer.absorptivity, layer.absorptivity_standard_error), count(layer.rays),
            significant(layer.mean_bounces)),
        csv_name("absorbed_energy", layer));
  }
  return pairs(figures);
}

std::string melt_section_figures(ReportInput const& input) {
  double hottest = 0;
  for (LayerRecord const* layer : input.shown)
    for (MeltSection const& section : layer->sections)
      for (std::size_t cell = 0; cell < section.state.size(); ++cell)
        if (section.state[cell] != 0) hottest = std::max(hottest, static_cast<double>(section.peak_temperature[cell]));
  Material const& metal = input.checked.material;
  double const top = metal.boiling_point > 0 ? std::min(hottest, metal.boiling_point) : hottest;
  double const low = input.checked.heat.ambient_temperature;
  ColourScale const scale{ColourMap::heat, "peak T [K]", low, std::max(top, low + 1), metal.liquidus, "liquidus"};
  std::string figures;
  for (LayerRecord const* layer : input.shown)
    for (MeltSection const& section : layer->sections) figures += section_figure(*layer, section, scale);
  return grid(figures);
}

std::string part_surface_maps(ReportInput const& input) {
  std::vector<Raster> maps;
  double const thickness = 1e6 * input.checked.machine.layer_thickness;
  for (LayerRecord const* layer : input.shown)
    maps.push_back(raster_of(layer->part_surface, 1e6, thickness * layer->layer));
  ColourScale const scale = common_scale(maps, ColourMap::height, "height above the plate [\xc2\xb5m]", {0, 1});
  std::string figures;
  for (std::size_t k = 0; k < maps.size(); ++k) {
    if (maps[k].values.empty()) continue;
    LayerRecord const& layer = *input.shown[k];
    figures += figure(map_plot(maps[k], scale, "x [\xc2\xb5m]", "y [\xc2\xb5m]", {}, map_width(maps[k])),
                      fmt::format("The solid after <b>layer {}</b>; nominal height {} &micro;m.", layer.layer,
                                  chosen(thickness * layer.layer)),
                      csv_name("part_surface", layer));
  }
  return pairs(figures);
}

std::string trends(ReportInput const& input) {
  RunRecord const& r = input.record;
  if (r.layers.size() < 2) return "";
  using L = LayerRecord const&;
  std::string figures =
      trend("thickness [\xc2\xb5m]",
            {over_layers(r, "effective", [](L l) { return 1e6 * l.metrics.effective_thickness; }),
             over_layers(r, "real effective", [](L l) { return 1e6 * l.metrics.real_effective_thickness; })}) +
      trend("volume fraction", {over_layers(r, "nominal", [](L l) { return l.metrics.volume_fraction_nominal; }),
                                over_layers(r, "real", [](L l) { return l.metrics.volume_fraction_real; }),
                                over_layers(r, "surface coverage", [](L l) { return l.metrics.surface_coverage; })}) +
      trend("diameter by volume [\xc2\xb5m]", {over_layers(r, "D10", [](L l) { return 1e6 * l.metrics.d10; }),
                                               over_layers(r, "D50", [](L l) { return 1e6 * l.metrics.d50; }),
                                               over_layers(r, "D90", [](L l) { return 1e6 * l.metrics.d90; })});
  figures += trend("heap angle [deg]", {over_layers(
                                            r, "accumulation", [](L l) { return l.stroke.heap_angle_accumulation; },
                                            [](L l) { return or_none(l.stroke.heap_angle_accumulation_u_num); }),
                                        over_layers(
                                            r, "deposition", [](L l) { return l.stroke.heap_angle_deposition; },
                                            [](L l) { return or_none(l.stroke.heap_angle_deposition_u_num); })});
  if (input.laser()) {
    figures += trend("absorptivity", {over_layers(
                                         r, "absorptivity", [](L l) { return l.absorptivity; },
                                         [](L l) { return l.absorptivity_standard_error; })});
    figures += trend(
        "melt pool [\xc2\xb5m]",
        {over_layers(
             r, "width", [](L l) { return 1e6 * l.pool.width; }, [](L l) { return 1e6 * l.pool_u_num.width; }),
         over_layers(
             r, "depth", [](L l) { return 1e6 * l.pool.depth; }, [](L l) { return 1e6 * l.pool_u_num.depth; }),
         over_layers(
             r, "length", [](L l) { return 1e6 * l.pool.length; }, [](L l) { return 1e6 * l.pool_u_num.length; })});
  }
  if (input.part_grows())
    figures += trend("relative density of the part",
                     {over_layers(r, "density", [](L l) { return l.consolidation.part_relative_density; })});
  return grid(figures);
}

std::string wall_time_bar(ReportInput const& input) {
  WallTime const& t = input.record.wall_time;
  double const rest = std::max(0.0, t.total - t.dem - t.rays - t.heat - t.mesh - t.io);
  return figure(share_bar({{"powder (DEM)", t.dem},
                           {"rays", t.rays},
                           {"heat", t.heat},
                           {"solid and mesh", t.mesh},
                           {"pictures and files", t.io},
                           {"rest", rest}},
                          "s"),
                fmt::format("{} s in all.", significant(t.total)), "wall_time.csv");
}

}  // namespace layerloop::coupling
