#pragma once
#include <cstdint>

#include "validation/study.hpp"

namespace layerloop::validation {

/// A study without readings for the analytic chain: 50 conditions over power, speed, spot, layer, recoating speed,
/// hatch and ambient temperature on two machines, five builds and two lots; ten of them are held out. About 190
/// training rows in four sys_groups with replicates, and five calibration numbers. Values are left at 0.
Study analytic_design(std::uint64_t seed);

/// The observations of one role; all conditions stay, observables that nothing reads go.
Study part_of(Study const& study, Role role);

}  // namespace layerloop::validation
