#include "coupling/material_mass.hpp"

#include <algorithm>
#include <cmath>

#include "core/compensated_sum.hpp"

namespace layerloop::coupling {
namespace {

/// Standard deviation of the share of a material in the mass of grains of these volumes that are drawn at random from
/// powder.mixture. To first order s = sum m_i t_i / sum m_i scatters by sqrt(sum <m_i^2 (t_i - w)^2>) / <sum m_i>;
/// sizes do not depend on the material.
double share_scatter(std::vector<Material> const& metals, std::size_t material, std::vector<double> const& volumes,
                     Case const& checked) {
  double volume = 0, volume_squares = 0, density = 0, squares = 0, number = 0;
  for (double const v : volumes) volume += v, volume_squares += v * v;
  double const w = checked.powder.mixture.at(metals[material].name);
  for (std::size_t m = 0; m < metals.size(); ++m) {
    double const rho = metals[m].density, n = checked.powder.mixture.at(metals[m].name) / rho;  // shares by number
    number += n;
    density += n * rho;
    squares += n * rho * rho * std::pow((m == material ? 1.0 : 0.0) - w, 2);
  }
  return std::sqrt(squares * number * volume_squares) / (density * volume);
}

}  // namespace

std::vector<double> mass_by_material(PowderBed const& bed, Case const& checked) {
  std::vector<CompensatedSum> volume(1 + checked.admixtures.size());
  for (std::size_t i = 0; i < bed.size(); ++i)
    volume.at(volume.size() > 1 ? static_cast<std::size_t>(bed.material[i]) : 0).add(bed.volume(i));
  std::vector<double> mass;
  for (std::size_t m = 0; m < volume.size(); ++m)
    mass.push_back(checked.density(static_cast<std::int32_t>(m)) * volume[m].value());
  return mass;
}

double sum_of(std::vector<double> const& masses) {
  double sum = 0;
  for (double const mass : masses) sum += mass;
  return sum;
}

std::vector<MaterialShare> material_shares(PowderBed const& bed, std::vector<std::int64_t> const& before,
                                           std::vector<double> const& mass_fed, Case const& checked) {
  std::vector<double> volumes, mass(1 + checked.admixtures.size());
  for (std::size_t i = 0; i < bed.size(); ++i) {
    bool const inside = bed.x[i] >= checked.machine.deposition_begin() && bed.x[i] < checked.machine.deposition_end();
    if (!inside || std::ranges::binary_search(before, bed.id[i])) continue;
    volumes.push_back(bed.volume(i));
    mass.at(static_cast<std::size_t>(bed.material[i])) += checked.density(bed.material[i]) * bed.volume(i);
  }
  std::vector<Material> const metals = checked.materials();
  std::vector<MaterialShare> shares;
  for (std::size_t m = 0; m < metals.size(); ++m)
    shares.push_back({metals[m].name, mass_fed.at(m) / sum_of(mass_fed), mass[m] / sum_of(mass),
                      share_scatter(metals, m, volumes, checked)});
  return shares;
}

}  // namespace layerloop::coupling
