#pragma once
#include <string>

#include "core/units.hpp"

namespace layerloop::validation {

/// Unit in which people read a quantity or an input, and what an SI value is multiplied by.
struct Display {
  Dimension dimension = Dimension::none;
  std::string unit = {};
  double factor = 1;
  std::string label(std::string const& name) const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

/// Of a quantity ("pool.depth") or a key of the case ("laser.power").
Display display_of(std::string const& name);

/// "pool.depth = 84 um" without the unit's name where it has none.
std::string value_in_words(std::string const& name, double value);

}  // namespace layerloop::validation
