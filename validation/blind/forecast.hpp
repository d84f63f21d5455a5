#pragma once
#include <map>
#include <string>
#include <vector>

#include "validation/blind/judgement.hpp"

namespace layerloop::validation {

/// How well held-out rows were predicted. Distances from the truth, in units of u_stat, rms over the rows.
struct Forecast {
  double calibrated = 0;  ///< the model, calibrated
  double named = 0;       ///< with what the diagnosis found
  double smooth = 0;      ///< calibrated, with a nameless Gaussian process a quantity (Kennedy & O'Hagan 2001)
  double whitened = 0;    ///< readings minus the model with what was found, whitened
};

/// \param truth  by obs_id
Forecast forecast_of(World const& world, Study const& training, Study const& holdout,
                     std::vector<std::string> const& withheld, std::map<std::string, double> const& truth,
                     Judgement const& judgement);

}  // namespace layerloop::validation
