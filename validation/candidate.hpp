#pragma once
#include <string>
#include <vector>

#include "core/effect_catalogue.hpp"

namespace layerloop::validation {

/// A cause that the model may lack: an effect of the catalogue, its discretisation, an input or the instrument.
struct Candidate {
  std::string name;   ///< "keyhole", "heat.cell_size", "offset of pool.depth"
  EffectStage stage;  ///< where it acts; of an instrument: that of its quantity
  EffectClass kind = EffectClass::physics;
  double prior_scale = 1;                    ///< strength that it may well have
  double largest = 10;                       ///< bound of the strength
  bool two_sided = false;                    ///< the strength may be negative
  std::string sentence = {};                 ///< what it is, in words
  std::vector<std::string> quantities = {};  ///< of an instrument: what it reads; empty: all
  bool specified = false;  ///< prior_scale is the uncertainty of a gauge or a setting, not an order of magnitude
};

}  // namespace layerloop::validation
