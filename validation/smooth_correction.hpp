#pragma once
#include <Eigen/Core>

#include "validation/error_model.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// What a smooth correction may depend on: the inputs and words of the conditions that vary, place, layer, and order of
/// acquisition; (observations, inputs), every column from 0 to 1.
Eigen::MatrixXd smooth_inputs(Study const& study);

/// Share, from 0 to 1, of the excess of chi2 over its degrees of freedom that a smooth correction without any physics
/// takes away: one Gaussian process a quantity, in what calibration leaves (Plumlee, J. Am. Stat. Assoc. 112 (2017)
/// 1274), each condition predicted from all others. 0 when there is no excess.
/// \param whitened_residual  measured minus calibrated \param sigma2  square of the factor on all uncertainties
double smooth_share(Study const& study, Eigen::VectorXd const& whitened_residual, Projection const& projection,
                    double sigma2);

}  // namespace layerloop::validation
