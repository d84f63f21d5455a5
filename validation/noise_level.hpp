#pragma once
#include <vector>

#include "validation/diagnosis.hpp"
#include "validation/pattern.hpp"
#include "validation/refit.hpp"
#include "validation/signature.hpp"

namespace layerloop::validation {

/// How far the scatter of the data is from what their uncertainties promise.
struct NoiseLevel {
  double sigma2 = 1;  ///< square of the factor on all uncertainties, at least 1
  double from_replicates = 1, replicate_dof = 0;
  double from_fit = 1, fit_dof = 0;  ///< under the permissive model
  std::vector<OutlierFinding> outliers;
};

/// Of every level of every label, and of every place in the order of acquisition; rows that are spared are none of it.
std::vector<Jump> jumps_in(ResidualFrame const& frame, Fit const& fit);

/// Scale and outliers under a permissive model, that may do everything which calibration, the candidates that fit and
/// the strongest patterns can do: what is left has no smooth cause. Replicates count where they disagree with it.
/// Spares the outliers in the frame and takes them out of fit and signatures. The largest residual goes first (Grubbs),
/// a small share of the data at most.
NoiseLevel find_noise_level(ResidualFrame& frame, Fit& fit, Signatures& signatures, Patterns& patterns,
                            Thresholds const& thresholds);

}  // namespace layerloop::validation
