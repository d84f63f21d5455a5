#pragma once

namespace layerloop::validation {

/// Half width and depth of Eagar and Tsai's pool (Welding Journal 62 (1983) 346s) over the beam's 1/e2 radius, by
/// direct quadrature at every call; not a number where nothing melts. Numbers as for dimensionless_pool.
struct TruePool {
  double half_width, depth;
};
TruePool true_pool(double power, double speed);

}  // namespace layerloop::validation
