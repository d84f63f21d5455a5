#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace layerloop::coupling {

/// A quantity as people read it: value in the summary times `scale`.
struct ShownQuantity {
  std::string key;  ///< with dots where it lies deeper: "pool.depth"
  std::string label, unit;
  double scale = 1;
};

/// Of one of `layers` in the summary of a layer loop.
std::vector<ShownQuantity> layer_quantities();
/// Of the summary of a track or patch, of light on a bed, of pile and plate.
std::vector<ShownQuantity> exposure_quantities();

/// "roughness Sa [um]", with the micro sign.
std::string title_of(ShownQuantity const& quantity);
/// " [um]" behind a column's name; nothing without a unit.
std::string column_unit(ShownQuantity const& quantity);

/// Number under a key with dots; not a number where there is none.
double figure_in(nlohmann::json const& from, std::string const& key);

}  // namespace layerloop::coupling
