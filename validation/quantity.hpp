#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/effect_catalogue.hpp"
#include "coupling/absorption_study.hpp"
#include "coupling/calibration.hpp"
#include "coupling/melt_study.hpp"
#include "coupling/run_record.hpp"
#include "coupling/verb.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// What the model says of one quantity. SI.
struct Reading {
  double value;            ///< not a number: there is nothing to measure
  double u_numerical = 0;  ///< standard uncertainty from mesh and time step
  double u_sampling = 0;   ///< standard error from rays, grains and sections within this one run
};

/// Part of the layer or pool that is meant; nothing: all of it.
struct Spot {
  std::optional<int> layer = {};         ///< 1-based
  std::optional<double> x = {}, y = {};  ///< [m]

  auto operator<=>(Spot const&) const = default;
};

using coupling::Verb;

/// Something that can be measured, and how the program comes by it: the observation operator. A verb that does not give
/// it has no function.
struct Quantity {
  std::string name;
  Dimension dimension;
  EffectStage stage;
  Verb verb;
  Range range;             ///< in which a reading must lie [SI]: catches a slip of the unit
  std::string definition;  ///< in the words of the verb's summary
  std::function<Reading(coupling::RunRecord const&, Spot const&)> of_layers = {};
  std::function<Reading(coupling::MeltStudy const&, Spot const&)> of_melt = {};
  std::function<Reading(coupling::AbsorptionStudy const&)> of_light = {};
  std::function<Reading(coupling::CalibrationPoint const&)> of_angles = {};

  /// A word instead of a number.
  bool is_category() const { return name == "track.regime"; }
};

std::vector<Quantity> const& quantities();

/// Null when there is none of this name.
Quantity const* find_quantity(std::string const& name);

std::vector<std::string> quantity_names();

/// Words that `track.regime` may have; its value in a Prediction is the place of the word in this list.
std::vector<std::string> const& regime_words();

}  // namespace layerloop::validation
