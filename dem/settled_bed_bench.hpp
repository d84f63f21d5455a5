#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "core/bed_file.hpp"
#include "core/case.hpp"
#include "core/communicator.hpp"

namespace layerloop::dem {

/// The thesis' contact values (its Table 4 and section 3.2), for what runs without a case file; preset `thesis` has the
/// same.
ContactSettings thesis_contact();

/// How fast a settled bed is computed; over all ranks.
struct SettledBedBench {
  std::int64_t particles = 0, contacts = 0, steps = 0, rebuilds = 0;
  double seconds = 0;
  double imbalance = 1;                  ///< largest over mean work of the ranks
  std::map<std::string, double> phases;  ///< mean over the ranks [s]

  double particle_steps_per_second() const {
    return static_cast<double>(particles) * static_cast<double>(steps) / seconds;
  }
};

/// Starts a bed from rest with no history on a cohesive floor, with the thesis' contact model (E 0.2 GPa, nu 0.3,
/// e 0.7, friction 0.7, cdt 0.15, sjkr2 90000 J/m^3) and a step of 3.592e-8 s; no grain sleeps, every contact is
/// computed every step. 100 steps are made before the clock starts. Collective. \throws InputError no floor, or empty
SettledBedBench bench_settled_bed(BedFile file, std::int64_t steps, Communicator const& communicator);

}  // namespace layerloop::dem
