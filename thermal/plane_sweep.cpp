#include "thermal/plane_sweep.hpp"

namespace layerloop::thermal {

/// Flow through every contact [W/m], from the enthalpies before the step.
void contact_flows(HeatSystem& system) {
  std::vector<ContactFace> const& contacts = system.conduction.contacts;
  auto const temperature = [&](std::int64_t c) {
    return system.table.temperature(std::max(system.enthalpy[static_cast<std::size_t>(c)], system.floor));
  };
#pragma omp for
  for (std::size_t f = 0; f < contacts.size(); ++f) {
    ContactFace const& face = contacts[f];
    system.scratch.contact_flow[f] = face.conductivity * (temperature(face.neighbour) - temperature(face.cell));
  }
}

/// First plane of every thread's slab, and the end of the last: about as many awake cells in each.
std::vector<int> share_out(HeatSystem const& system, int threads) {
  auto const& first = system.conduction.first_row;
  std::vector<std::int64_t> until{0};
  for (std::size_t k = 0; k + 1 < first.size(); ++k) {
    std::int64_t cells = 0;
    for (std::size_t r = first[k]; r < first[k + 1]; ++r)
      cells += system.awake.stepped()[r].end - system.awake.stepped()[r].begin;
    until.push_back(until.back() + cells);
  }
  std::vector<int> begin;
  for (int t = 0; t < threads; ++t)
    begin.push_back(static_cast<int>(std::ranges::lower_bound(until, until.back() * t / threads) - until.begin()));
  begin.front() = 0;
  begin.push_back(static_cast<int>(until.size()) - 1);
  return begin;
}

}  // namespace layerloop::thermal
