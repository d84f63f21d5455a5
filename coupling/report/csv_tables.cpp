#include "coupling/report/csv_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "coupling/report/csv_table.hpp"

namespace layerloop::coupling {
namespace {

void write_layers(ReportInput const& input) {
  CsvTable table(
      "layer,grains,effective_thickness [um],real_effective_thickness [um],void_layer "
      "[um],volume_fraction_nominal,volume_fraction_real,"
      "surface_coverage,roughness_sa [um],d10 [um],d50 [um],d90 [um],absorptivity,absorptivity_u_num,peak_temperature "
      "[K],pool_width [um],"
      "pool_width_u_num [um],pool_depth [um],pool_depth_u_num [um],pool_length [um],pool_length_u_num [um],melted_mass "
      "[kg],"
      "part_relative_density,roughness_sq [um],roughness_sz [um],d10_number [um],d50_number [um],d90_number "
      "[um],mean_diameter [um],sauter_diameter [um],mass_diameter [um],coordination_number,rattler_fraction,"
      "segregation_index,lacey_index,settled_height [um],settled_density,heap_angle_accumulation "
      "[deg],heap_angle_deposition [deg],reservoir_mean_diameter [um],reservoir_mass_ratio,blade_force [N]");
  for (LayerRecord const& l : input.record.layers) {
    LayerMetrics const& m = l.metrics;
    table.row({double(l.layer),
               double(l.grains_in_layer),
               1e6 * m.effective_thickness,
               1e6 * m.real_effective_thickness,
               1e6 * m.void_layer,
               m.volume_fraction_nominal,
               m.volume_fraction_real,
               m.surface_coverage,
               1e6 * m.roughness_sa,
               1e6 * m.d10,
               1e6 * m.d50,
               1e6 * m.d90,
               l.absorptivity,
               l.absorptivity_standard_error,
               l.peak_temperature,
               1e6 * l.pool.width,
               1e6 * l.pool_u_num.width,
               1e6 * l.pool.depth,
               1e6 * l.pool_u_num.depth,
               1e6 * l.pool.length,
               1e6 * l.pool_u_num.length,
               l.consolidation.melted_mass,
               l.consolidation.part_relative_density,
               1e6 * m.roughness_sq,
               1e6 * m.roughness_sz,
               1e6 * m.d10_number,
               1e6 * m.d50_number,
               1e6 * m.d90_number,
               1e6 * m.mean_diameter,
               1e6 * m.sauter_diameter,
               1e6 * m.mass_diameter,
               m.coordination_number,
               m.rattler_fraction,
               m.segregation_index,
               m.lacey_index,
               1e6 * l.stroke.settled_height,
               l.stroke.settled_density,
               l.stroke.heap_angle_accumulation,
               l.stroke.heap_angle_deposition,
               1e6 * l.stroke.reservoir_mean_diameter,
               l.stroke.reservoir_mass_ratio,
               l.stroke.blade_force});
  }
  table.write(input.folder / "layers.csv");
}

void write_profiles(ReportInput const& input) {
  CsvTable table(
      "layer,x [um],relative_density,effective_thickness [um],mean_diameter [um],grains,real_effective_thickness "
      "[um],volume_fraction_nominal,surface_coverage,roughness_sa [um],d50 [um],coordination_number");
  for (LayerRecord const& layer : input.record.layers)
    for (LayerBin const& bin : layer.metrics.bins)
      table.row({double(layer.layer), 1e6 * bin.x, bin.volume_fraction_real, 1e6 * bin.effective_thickness,
                 1e6 * bin.mean_diameter, double(bin.grains), 1e6 * bin.real_effective_thickness,
                 bin.volume_fraction_nominal, bin.surface_coverage, 1e6 * bin.roughness_sa, 1e6 * bin.d50,
                 bin.coordination_number});
  table.write(input.folder / "profiles.csv");
}

void write_map(AreaMap const& map, std::string_view quantity, double scale, double offset,
               std::filesystem::path const& path) {
  CsvTable table(fmt::format("x [um],y [um],{}", quantity));
  for (std::int32_t j = 0; j < map.ny; ++j)
    for (std::int32_t i = 0; i < map.nx; ++i)
      table.row({1e6 * (map.x0 + (i + 0.5) * map.spacing), 1e6 * (map.y0 + (j + 0.5) * map.spacing),
                 scale * map.at(i, j) + offset});
  table.write(path);
}

void write_sections(ReportInput const& input) {
  CsvTable table("layer,x [um],y [um],z [um],peak_temperature [K],before (0 gas 1 powder 2 solid),melted");
  for (LayerRecord const* layer : input.shown) {
    for (MeltSection const& s : layer->sections) {
      for (std::int32_t k = 0; k < s.nz; ++k) {
        for (std::int32_t j = 0; j < s.ny; ++j) {
          auto const cell = static_cast<std::size_t>(j + std::int64_t{s.ny} * k);
          table.row({double(layer->layer), 1e6 * s.x, 1e6 * (s.y0 + (j + 0.5) * s.cell),
                     1e6 * (s.z0 + (k + 0.5) * s.cell), s.peak_temperature[cell], double(s.state[cell] & 3),
                     double(s.state[cell] >> 2)});
        }
      }
    }
  }
  table.write(input.folder / "sections.csv");
}

void write_sizes(ReportInput const& input) {
  CsvTable table("diameter [um],fed_number_share,bed_number_share,plate_number_share");
  for (SizeShares const& s : size_shares(input.checked, input.bed))
    table.row({1e6 * s.diameter, s.fed, s.bed, s.plate});
  table.write(input.folder / "size_distribution.csv");
}

}  // namespace

std::vector<SizeShares> size_shares(Case const& checked, PowderBed const& bed) {
  PowderSettings const& powder = checked.powder;
  std::vector<SizeShares> shares;
  double fed = 0, in_bed = 0, on_plate = 0;
  for (std::size_t k = 0; k < powder.diameters.size(); ++k) {
    double const d = powder.diameters[k];
    double const number = powder.basis == SizeBasis::number ? powder.fractions[k] : powder.fractions[k] / (d * d * d);
    shares.push_back({d, number, 0, 0});
    fed += number;
  }
  for (std::size_t i = 0; i < bed.size() && !shares.empty(); ++i) {
    auto const nearest = std::min_element(shares.begin(), shares.end(), [&](SizeShares const& a, SizeShares const& b) {
      return std::abs(a.diameter - 2 * bed.radius[i]) < std::abs(b.diameter - 2 * bed.radius[i]);
    });
    nearest->bed += 1;
    in_bed += 1;
    if (bed.x[i] < checked.machine.deposition_begin() || bed.x[i] > checked.machine.deposition_end()) continue;
    nearest->plate += 1;
    on_plate += 1;
  }
  for (SizeShares& share : shares) {
    share.fed /= fed;
    share.bed /= std::max(1.0, in_bed);
    share.plate /= std::max(1.0, on_plate);
  }
  return shares;
}

void write_csv_tables(ReportInput const& input) {
  write_layers(input);
  write_profiles(input);
  write_sizes(input);
  WallTime const& time = input.record.wall_time;
  CsvTable wall_time("dem [s],rays [s],heat [s],mesh [s],io [s],total [s]");
  wall_time.row({time.dem, time.rays, time.heat, time.mesh, time.io, time.total});
  wall_time.write(input.folder / "wall_time.csv");
  if (input.laser()) write_sections(input);
  for (LayerRecord const* layer : input.shown) {
    auto const path = [&](std::string_view name) {
      return input.folder / fmt::format("{}_{:04}.csv", name, layer->layer);
    };
    double const above_plate = 1e6 * input.checked.machine.layer_thickness * layer->layer;
    write_map(layer->metrics.surface, "surface [um]", 1e6, 0, path("surface"));
    if (input.part_grows())
      write_map(layer->part_surface, "height_above_plate [um]", 1e6, above_plate, path("part_surface"));
    if (input.laser()) write_map(layer->absorbed_energy, "absorbed_energy [J/mm2]", 1e-6, 0, path("absorbed_energy"));
  }
}

}  // namespace layerloop::coupling
