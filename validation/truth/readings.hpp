#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "validation/study.hpp"

namespace layerloop::validation {

/// How readings scatter about the truth.
struct ReadingErrors {
  bool heavy_tails = false;        ///< Student's t with 5 degrees of freedom instead of a normal distribution
  double noise_factor = 1;         ///< true scatter over the stated one
  double outlier_share = 0;        ///< of the rows, wrong by 6 to 8 u_stat
  std::string omitted_group = {};  ///< sys_group whose error is there, twice as large, but not stated
};

/// How the name of a sys_group begins whose error is in the truth already: that of the beds that were measured.
inline constexpr auto group_of_beds = "bed ";

/// Fills in the values of a study: one error a sys_group, one a row. \param truth  by observable [SI]
void take_readings(Study& study, Eigen::VectorXd const& truth, ReadingErrors const& errors, std::uint64_t seed);

/// A standard normal number, a pure function of its arguments.
double standard_normal_at(std::uint64_t seed, std::uint64_t id, std::uint32_t draw);

}  // namespace layerloop::validation
