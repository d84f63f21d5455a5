#include "dem/layer_metrics.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::dem {
namespace {
constexpr std::size_t bins = 15;
constexpr double no_thickness = 1e-9;  // [m]: a layer thinner than this has no volume fraction

/// Part of the deposition zone along x.
struct Span {
  double from, to;
  bool holds(double x) const { return x >= from && x < to; }
};

Span interior(Case const& checked) {
  MachineSettings const& m = checked.machine;
  double const margin = std::min(2 * *std::ranges::max_element(checked.powder.diameters), m.deposition_length / 4);
  return {m.deposition_begin() + margin, m.deposition_end() - margin};
}

Span bin_span(MachineSettings const& m, std::size_t bin) {
  double const width = m.deposition_length / bins;
  double const begin = m.deposition_begin() + static_cast<double>(bin) * width;
  return {begin, bin + 1 == bins ? m.deposition_end() : begin + width};
}

double volume_in(PowderBed const& bed, Span span) {
  double volume = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) volume += span.holds(bed.x[i]) ? bed.volume(i) : 0.0;
  return volume;
}

/// Mean of value(pixel) over the pixels with their centre in the span.
template <class Value>
double mean_over(AreaMap const& map, Span span, Value const& value) {
  double sum = 0;
  std::int64_t count = 0;
  for (std::int32_t i = 0; i < map.nx; ++i) {
    if (!span.holds(map.x0 + (i + 0.5) * map.spacing)) continue;
    for (std::int32_t j = 0; j < map.ny; ++j) sum += value(i, j);
    count += map.ny;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

double mean_height(AreaMap const& map, Span span) {
  return mean_over(map, span, [&](std::int32_t i, std::int32_t j) { return map.at(i, j); });
}

double area(MachineSettings const& machine, Span span) { return (span.to - span.from) * machine.width; }

/// Rows of the grains in the span that were not in the zone before.
std::vector<std::size_t> new_grains(PowderBed const& bed, Span span, std::vector<std::int64_t> const& before) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (span.holds(bed.x[i]) && !std::ranges::binary_search(before, bed.id[i])) rows.push_back(i);
  }
  return rows;
}

/// Smallest diameter such that grains up to it hold at least this share of the volume; 0 without grains.
double volume_quantile(PowderBed const& bed, std::vector<std::size_t> rows, double share) {
  std::ranges::sort(rows, {}, [&](std::size_t i) { return bed.radius[i]; });
  double total = 0, below = 0;
  for (std::size_t const i : rows) total += bed.volume(i);
  for (std::size_t const i : rows) {
    below += bed.volume(i);
    if (below >= share * total) return 2 * bed.radius[i];
  }
  return rows.empty() ? 0.0 : 2 * bed.radius[rows.back()];
}

LayerBin measure_bin(PowderBed const& bed, LayerBase const& before, HeightMap const& surface, Case const& checked,
                     std::size_t bin) {
  Span const span = bin_span(checked.machine, bin);
  double const height = mean_height(surface, span), thickness = height - mean_height(before.surface, span);
  double const added = volume_in(bed, span) - before.volume_by_bin[bin];
  std::vector<std::size_t> const rows = new_grains(bed, span, before.grains);
  double diameters = 0;
  for (std::size_t const i : rows) diameters += 2 * bed.radius[i];
  return {.x = 0.5 * (span.from + span.to),
          .relative_density = thickness > no_thickness ? added / (area(checked.machine, span) * thickness) : 0.0,
          .effective_thickness = height + checked.machine.layer_thickness - checked.machine.blade_clearance,
          .mean_diameter = rows.empty() ? 0.0 : diameters / static_cast<double>(rows.size()),
          .grains = static_cast<std::int64_t>(rows.size())};
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
  LayerBase base{height_map(bed, solid), {}, std::vector<double>(bins), volume_in(bed, interior(checked))};
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (Span{m.deposition_begin(), m.deposition_end()}.holds(bed.x[i])) base.grains.push_back(bed.id[i]);
  }
  for (std::size_t b = 0; b < bins; ++b) base.volume_by_bin[b] = volume_in(bed, bin_span(m, b));
  return base;
}

LayerMetrics measure_layer(PowderBed const& bed, HeightMap const& solid, LayerBase const& before, Case const& checked) {
  MachineSettings const& m = checked.machine;
  Span const inside = interior(checked);
  LayerMetrics metrics;
  metrics.surface = height_map(bed, solid);
  HeightMap const& after = metrics.surface;
  double const height = mean_height(after, inside), height_before = mean_height(before.surface, inside);
  double const added = volume_in(bed, inside) - before.interior_volume;
  metrics.effective_thickness = height + m.layer_thickness - m.blade_clearance;
  metrics.real_effective_thickness = height - height_before;
  metrics.void_layer = m.blade_clearance - height_before;
  metrics.volume_fraction_nominal = added / (area(m, inside) * m.layer_thickness);
  if (metrics.real_effective_thickness > no_thickness)
    metrics.volume_fraction_real = added / (area(m, inside) * metrics.real_effective_thickness);

  double const raised = 0.25 * *std::ranges::min_element(checked.powder.diameters);
  metrics.surface_coverage = mean_over(after, inside, [&](std::int32_t i, std::int32_t j) {
    return after.at(i, j) > before.surface.at(i, j) + raised ? 1.0 : 0.0;
  });
  metrics.roughness_sa =
      mean_over(after, inside, [&](std::int32_t i, std::int32_t j) { return std::abs(after.at(i, j) - height); });

  std::vector<std::size_t> const rows = new_grains(bed, inside, before.grains);
  metrics.d10 = volume_quantile(bed, rows, 0.1);
  metrics.d50 = volume_quantile(bed, rows, 0.5);
  metrics.d90 = volume_quantile(bed, rows, 0.9);
  for (std::size_t b = 0; b < bins; ++b) metrics.bins.push_back(measure_bin(bed, before, after, checked, b));
  return metrics;
}

std::map<std::string, std::string> definitions() {
  std::string const interior =
      " Taken over the interior of the deposition zone: its full width, without two largest grain diameters at either "
      "end along x.";
  return {
      {"effective_thickness",
       "ELT: mean height of the surface after spreading above the plane one nominal layer thickness below the "
       "blade. The surface is the top of the highest grain or solid over the centre of each pixel." +
           interior},
      {"real_effective_thickness",
       "RELT: mean height of the surface after spreading minus that before it, both with the plate lowered." +
           interior},
      {"void_layer",
       "VL: height of the blade's lower edge minus the mean height of the surface before spreading; VL(n+1) = NLT(n+1) "
       "+ "
       "NLT(n) - ELT(n) where nothing moves between the layers." +
           interior},
      {"volume_fraction_nominal",
       "Volume of the grains in the zone after spreading minus that before it, over area times nominal layer "
       "thickness; grains count by their centre." +
           interior},
      {"volume_fraction_real", "The same volume over area times RELT; 0 without a layer." + interior},
      {"surface_coverage",
       "Share of the area seen from above that spreading has raised by more than a quarter of the smallest grain "
       "diameter: where a grain of this layer is on top." +
           interior},
      {"roughness_sa",
       "Sa: mean distance of the surface after spreading from its mean height (no filter, no tilt removed)." +
           interior},
      {"d10",
       "Smallest diameter such that grains up to it hold 10 % of the volume of the grains that were not in the zone "
       "before." +
           interior},
      {"d50", "The same for 50 %." + interior},
      {"d90", "The same for 90 %." + interior},
      {"bins",
       "15 equal slices of the whole deposition zone along x. relative_density: added grain volume over slice area "
       "times RELT of "
       "the slice; effective_thickness: as ELT; mean_diameter: number mean of the grains that were not in the zone "
       "before."},
  };
}

}  // namespace layerloop::dem
