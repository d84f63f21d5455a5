#pragma once
#include <string>

#include "validation/comparison.hpp"

namespace layerloop::validation {

// Each returns figures as HTML; empty where there is nothing to show.
std::string parity_figures(Comparison const& compared);    ///< one a quantity, with error bars
std::string residual_figures(Comparison const& compared);  ///< E / u_val over inputs, place, layer and order

}  // namespace layerloop::validation
