#pragma once

namespace layerloop::validation {

/// Half width and depth of a melt pool over the beam's 1/e2 radius; not a number where nothing melts.
struct DimensionlessPool {
  double half_width, depth;
};

/// The pool of Eagar and Tsai (thermal/eagar_tsai.hpp), interpolated smoothly from a table that is made at first use.
/// \param power  absorbed power / (conductivity, radius, melting minus ambient temperature), up to exp(6) times what
///               just melts
/// \param speed  speed times radius / diffusivity, 0.5 to 80
DimensionlessPool dimensionless_pool(double power, double speed);

}  // namespace layerloop::validation
