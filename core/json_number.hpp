#pragma once
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace layerloop {

/// JSON knows no NaN and no infinity: they are written as null.
inline nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}
/// And null is read as not a number.
inline double number_or_nan(nlohmann::json const& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace layerloop
