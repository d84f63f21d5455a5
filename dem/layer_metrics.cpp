#include "dem/layer_metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/grain_size.hpp"
#include "dem/coordination.hpp"
#include "dem/disc_union.hpp"
#include "dem/grain_sizes.hpp"

namespace layerloop::dem {
namespace {
constexpr double no_thickness = 1e-9;  // [m]: a layer thinner than this has no volume fraction
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Part of the deposition zone along x.
struct Span {
  double from, to;
  bool holds(double x) const { return x >= from && x < to; }
  double centre() const { return 0.5 * (from + to); }
};

Span interior(Case const& checked) {
  MachineSettings const& m = checked.machine;
  double const margin = std::min(2 * *std::ranges::max_element(checked.powder.diameters), m.deposition_length / 4);
  return {m.deposition_begin() + margin, m.deposition_end() - margin};
}

/// The interior, then every bin.
std::vector<Span> zones(Case const& checked) {
  MachineSettings const& m = checked.machine;
  std::vector<Span> all{interior(checked)};
  auto const edge = [&](std::int64_t bin) {
    return bin == checked.run.bins ? m.deposition_end()
                                   : m.deposition_begin() + static_cast<double>(bin) * m.deposition_length /
                                                                static_cast<double>(checked.run.bins);
  };
  for (std::int64_t bin = 0; bin < checked.run.bins; ++bin) all.push_back({edge(bin), edge(bin + 1)});
  return all;
}

double volume_in(PowderBed const& bed, Span span) {
  double volume = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) volume += span.holds(bed.x[i]) ? bed.volume(i) : 0.0;
  return volume;
}

/// Heights of the pixels with their centre in the span.
std::vector<double> heights_in(HeightMap const& map, Span span) {
  std::vector<double> heights;
  for (std::int32_t i = 0; i < map.nx; ++i) {
    if (!span.holds(map.x0 + (i + 0.5) * map.spacing)) continue;
    for (std::int32_t j = 0; j < map.ny; ++j) heights.push_back(map.at(i, j));
  }
  return heights;
}

double mean(std::vector<double> const& values) {
  double sum = 0;
  for (double const value : values) sum += value;
  return values.empty() ? nothing : sum / static_cast<double>(values.size());
}

/// A spread layer, and what was there before.
struct SpreadLayer {
  PowderBed const& bed;
  HeightMap const &before, &after;
  Case const& checked;
  std::vector<std::size_t> added;      ///< rows of the grains in the deposition zone that were not there before
  std::vector<std::int32_t> contacts;  ///< of every grain
  std::vector<RimArc> rim;             ///< of the added grains seen from above
};

std::vector<std::size_t> added_in(SpreadLayer const& layer, Span span) {
  std::vector<std::size_t> rows;
  for (std::size_t const i : layer.added)
    if (span.holds(layer.bed.x[i])) rows.push_back(i);
  return rows;
}

std::vector<double> radii_of(PowderBed const& bed, std::vector<std::size_t> const& rows) {
  std::vector<double> radii;
  for (std::size_t const i : rows) radii.push_back(bed.radius[i]);
  return radii;
}

/// What the pixels of a zone say of its surface.
struct SurfaceFigures {
  double height = 0, rise = 0, sa = 0, sq = 0, sz = 0;
};

SurfaceFigures surface_figures(std::vector<double> const& before, std::vector<double> const& after) {
  SurfaceFigures figures{mean(after), 0, 0, 0, 0};
  if (after.empty()) return {nothing, nothing, nothing, nothing, nothing};
  figures.rise = figures.height - mean(before);
  double const count = static_cast<double>(after.size());
  double square = 0;
  for (double const z : after) {
    figures.sa += std::abs(z - figures.height) / count;
    square += (z - figures.height) * (z - figures.height) / count;
  }
  figures.sq = std::sqrt(square);
  figures.sz = std::ranges::max(after) - std::ranges::min(after);
  return figures;
}

/// Standard error of figures from pixels: scatter between the four grids of every second pixel along x and y.
class PixelScatter {
 public:
  /// \param ny  pixels of a column, which follow one another
  PixelScatter(std::vector<double> const& before, std::vector<double> const& after, std::int32_t ny) {
    auto const rows = static_cast<std::size_t>(ny);
    for (std::size_t part = 0; part < grids_.size(); ++part) {
      std::vector<double> low, high;
      for (std::size_t p = 0; p < after.size(); ++p) {
        if (p / rows % 2 + 2 * (p % rows % 2) != part) continue;
        low.push_back(before[p]);
        high.push_back(after[p]);
      }
      grids_[part] = surface_figures(low, high);
    }
  }

  double of(double SurfaceFigures::*figure) const {
    double average = 0, square = 0;
    for (SurfaceFigures const& grid : grids_) average += grid.*figure / 4;
    for (SurfaceFigures const& grid : grids_) square += (grid.*figure - average) * (grid.*figure - average);
    return std::sqrt(square / 3 / 4);
  }

 private:
  std::array<SurfaceFigures, 4> grids_;
};

void measure_surface(ZoneMetrics& zone, SpreadLayer const& layer, Span span, double added_volume) {
  MachineSettings const& m = layer.checked.machine;
  std::vector<double> const before = heights_in(layer.before, span), after = heights_in(layer.after, span);
  SurfaceFigures const surface = surface_figures(before, after);
  PixelScatter const scatter(before, after, layer.after.ny);
  double const area = (span.to - span.from) * m.width;
  bool const is_there = surface.rise > no_thickness;
  zone.effective_thickness = surface.height + m.layer_thickness - m.blade_clearance;
  zone.effective_thickness_u_num = scatter.of(&SurfaceFigures::height);
  zone.real_effective_thickness = surface.rise;
  zone.real_effective_thickness_u_num = scatter.of(&SurfaceFigures::rise);
  zone.void_layer = m.blade_clearance - (surface.height - surface.rise);
  zone.volume_fraction_nominal = added_volume / (area * m.layer_thickness);
  zone.volume_fraction_real = is_there ? added_volume / (area * surface.rise) : nothing;
  zone.volume_fraction_real_u_num =
      std::abs(zone.volume_fraction_real) * zone.real_effective_thickness_u_num / surface.rise;
  zone.surface_coverage = area_between(layer.rim, span.from, span.to) / area;
  zone.roughness_sa = surface.sa;
  zone.roughness_sa_u_num = scatter.of(&SurfaceFigures::sa);
  zone.roughness_sq = surface.sq;
  zone.roughness_sz = surface.sz;
}

void measure_grains(ZoneMetrics& zone, SpreadLayer const& layer, Span span) {
  std::vector<std::size_t> const rows = added_in(layer, span);
  std::vector<double> const radii = radii_of(layer.bed, rows);
  zone.grains = static_cast<std::int64_t>(rows.size());
  zone.d10 = diameter_quantile(radii, 0.1, Weight::volume);
  zone.d50 = diameter_quantile(radii, 0.5, Weight::volume);
  zone.d90 = diameter_quantile(radii, 0.9, Weight::volume);
  zone.d10_number = diameter_quantile(radii, 0.1, Weight::number);
  zone.d50_number = diameter_quantile(radii, 0.5, Weight::number);
  zone.d90_number = diameter_quantile(radii, 0.9, Weight::number);
  zone.mean_diameter = mean_diameter(radii, 1, 0);
  zone.sauter_diameter = mean_diameter(radii, 3, 2);
  zone.mass_diameter = mean_diameter(radii, 4, 3);
  std::int64_t contacts = 0, rattlers = 0;
  for (std::size_t const i : rows) {
    contacts += layer.contacts[i];
    rattlers += layer.contacts[i] <= 1 ? 1 : 0;
  }
  double const grains = static_cast<double>(rows.size());
  zone.coordination_number = rows.empty() ? nothing : static_cast<double>(contacts) / grains;
  zone.rattler_fraction = rows.empty() ? nothing : static_cast<double>(rattlers) / grains;
}

/// Front: the third of the interior that the blade reaches first.
double segregation(SpreadLayer const& layer) {
  Span const inside = interior(layer.checked);
  double const third = (inside.to - inside.from) / 3;
  auto const d50 = [&](Span span) {
    return diameter_quantile(radii_of(layer.bed, added_in(layer, span)), 0.5, Weight::volume);
  };
  return (d50({inside.from, inside.from + third}) - d50({inside.to - third, inside.to})) /
         fed_diameter_quantile(fed_powder(layer.checked), 0.5, Weight::volume);
}

double lacey(SpreadLayer const& layer, std::vector<Span> const& bins) {
  double const median = fed_diameter_quantile(fed_powder(layer.checked), 0.5, Weight::number);
  std::vector<std::size_t> coarse, all;
  for (Span const bin : bins) {
    std::vector<std::size_t> const rows = added_in(layer, bin);
    all.push_back(rows.size());
    coarse.push_back(static_cast<std::size_t>(
        std::ranges::count_if(rows, [&](std::size_t i) { return 2 * layer.bed.radius[i] > median * (1 - 1e-9); })));
  }
  return lacey_index(coarse, all);
}

SpreadLayer spread_layer(PowderBed const& bed, HeightMap const& after, LayerBase const& before, Case const& checked) {
  MachineSettings const& m = checked.machine;
  SpreadLayer layer{bed, before.surface, after, checked, {}, touching_grains(bed, m.width), {}};
  std::vector<Disc> discs;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (bed.x[i] < m.deposition_begin() || bed.x[i] >= m.deposition_end()) continue;
    if (std::ranges::binary_search(before.grains, bed.id[i])) continue;
    layer.added.push_back(i);
    discs.push_back({bed.x[i], bed.y[i], bed.radius[i]});
  }
  layer.rim = rim_of_union(std::move(discs), m.width);
  return layer;
}
}  // namespace

HeightMap height_map(PowderBed const& bed, HeightMap const& base) {
  HeightMap map = base;
  auto const pixel = [&](double offset) { return static_cast<std::int32_t>(std::floor(offset / map.spacing)); };
  for (std::size_t g = 0; g < bed.size(); ++g) {
    double const r = bed.radius[g], left = bed.x[g] - r - map.x0;
    if (left + 2 * r < 0 || left > map.nx * map.spacing) continue;
    std::int32_t const i0 = std::max(0, pixel(left)), i1 = std::min(map.nx - 1, pixel(left + 2 * r));
    std::int32_t const j0 = pixel(bed.y[g] - r - map.y0), j1 = pixel(bed.y[g] + r - map.y0);
    for (std::int32_t jj = j0; jj <= j1; ++jj) {
      double const dy = map.y0 + (jj + 0.5) * map.spacing - bed.y[g];
      std::int32_t const j = (jj % map.ny + map.ny) % map.ny;
      for (std::int32_t i = i0; i <= i1; ++i) {
        double const dx = map.x0 + (i + 0.5) * map.spacing - bed.x[g], rest = r * r - dx * dx - dy * dy;
        if (rest > 0) map.at(i, j) = std::max(map.at(i, j), bed.z[g] + std::sqrt(rest));
      }
    }
  }
  return map;
}

LayerBase layer_base(PowderBed const& bed, HeightMap const& solid, Case const& checked) {
  MachineSettings const& m = checked.machine;
  LayerBase base{height_map(bed, solid), {}, {}};
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (Span{m.deposition_begin(), m.deposition_end()}.holds(bed.x[i])) base.grains.push_back(bed.id[i]);
  }
  for (Span const span : zones(checked)) base.volume.push_back(volume_in(bed, span));
  return base;
}

LayerMetrics measure_layer(PowderBed const& bed, HeightMap const& solid, LayerBase const& before, Case const& checked) {
  LayerMetrics metrics;
  metrics.surface = height_map(bed, solid);
  SpreadLayer const layer = spread_layer(bed, metrics.surface, before, checked);
  std::vector<Span> const spans = zones(checked);
  metrics.bins.resize(spans.size() - 1);
  for (std::size_t z = 0; z < spans.size(); ++z) {
    ZoneMetrics& zone = z == 0 ? static_cast<ZoneMetrics&>(metrics) : metrics.bins[z - 1];
    measure_surface(zone, layer, spans[z], volume_in(bed, spans[z]) - before.volume[z]);
    measure_grains(zone, layer, spans[z]);
    if (z > 0) metrics.bins[z - 1].x = spans[z].centre();
  }
  metrics.segregation_index = segregation(layer);
  metrics.lacey_index = lacey(layer, {spans.begin() + 1, spans.end()});
  return metrics;
}

}  // namespace layerloop::dem
