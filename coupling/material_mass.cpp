#include "coupling/material_mass.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/compensated_sum.hpp"

namespace layerloop::coupling {
namespace {

struct GrainMass {
  std::size_t material;
  double mass;
};

/// Share of one material in the mass of grains, and its standard error if they were drawn at random from a large
/// powder: that of a ratio of sums, s = sum m_i t_i / sum m_i, is sqrt(sum m_i^2 (t_i - s)^2) / sum m_i.
std::array<double, 2> share_of(std::size_t material, std::vector<GrainMass> const& grains) {
  double all = 0, own = 0, squares = 0;
  for (GrainMass const& g : grains) {
    all += g.mass;
    own += g.material == material ? g.mass : 0.0;
  }
  double const share = own / all;
  for (GrainMass const& g : grains) squares += std::pow(g.mass * ((g.material == material ? 1.0 : 0.0) - share), 2);
  return {share, std::sqrt(squares) / all};
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
  std::vector<GrainMass> added;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    bool const inside = bed.x[i] >= checked.machine.deposition_begin() && bed.x[i] < checked.machine.deposition_end();
    if (inside && !std::ranges::binary_search(before, bed.id[i]))
      added.push_back({static_cast<std::size_t>(bed.material[i]), checked.density(bed.material[i]) * bed.volume(i)});
  }
  std::vector<MaterialShare> shares;
  for (Material const& metal : checked.materials()) {
    std::size_t const m = shares.size();
    auto const [share, error] = share_of(m, added);
    shares.push_back({metal.name, mass_fed.at(m) / sum_of(mass_fed), share, error});
  }
  return shares;
}

}  // namespace layerloop::coupling
