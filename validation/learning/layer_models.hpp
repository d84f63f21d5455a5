#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "validation/learning/surrogate.hpp"

namespace layerloop::validation {

/// A run of several layers.
struct LayeredRun {
  std::size_t point = 0;  ///< runs of one point differ in their seed only
  Case const* checked = nullptr;
  std::vector<double> others = {};  ///< what was set beyond thickness, speed, dose and cohesion, alike in all runs
  nlohmann::json const* layers = nullptr;  ///< of its summary.json
};

/// What a layer is predicted from. The first two use what only a run tells, the others what can be set.
enum class LayerModel {
  layer_wise,  ///< roughness of the layer below and void layer
  steady,      ///< roughness and effective thickness of the layer below, recoating speed; of the last layer only
  settings,    ///< thickness / d, speed / sqrt(g d), dose, Bond number, and what else was set; of the last layer only
  settings_and_layer  ///< the same and the number of the layer
};

/// "layer-wise (roughness, void layer)"
std::string const& words_of(LayerModel model);

struct LayerSkill {
  LayerModel model;
  std::string output;
  Skill last, all;  ///< of the last layer of every run, and of all layers; n = 0: not what the model is for
};

/// Every model for every output, on the same runs, each point predicted from all others alone: layers of a run, and
/// runs that differ in their seed, are not independent. d: of the grain of mean volume. Outputs that do not vary are
/// left out.
std::vector<LayerSkill> compare_layer_models(std::vector<LayeredRun> const& runs,
                                             std::vector<std::string> const& outputs);

}  // namespace layerloop::validation
