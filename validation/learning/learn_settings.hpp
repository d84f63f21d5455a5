#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/report/shown_quantity.hpp"
#include "validation/learning/acquisition.hpp"

namespace layerloop::validation {

/// The table [learn] of a case file.
struct LearnSettings {
  coupling::ShownQuantity output;  ///< figure of the last layer, or of the summary of a verb without layers
  Goal goal = Goal::maximise;
  Acquisition acquisition = Acquisition::expected_improvement;
  std::int64_t runs = 0;   ///< places after the start design, each with every seed of the sweep
  std::uint64_t seed = 1;  ///< of the search
};

std::string const& name_of(Goal goal);
std::string const& name_of(Acquisition acquisition);

/// "um", without the micro sign.
std::string plain_unit(coupling::ShownQuantity const& quantity);

/// \param overrides  as for read_case: learn.runs=5 \throws InputError with every fault at its place; FileError
LearnSettings read_learn(std::filesystem::path const& path, std::vector<std::string> const& overrides);

}  // namespace layerloop::validation
