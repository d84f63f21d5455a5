#pragma once
#include "validation/noise_level.hpp"
#include "validation/selection.hpp"

namespace layerloop::validation {

/// What a verdict is reached from.
struct Evidence {
  Workbench const& bench;
  Fit const& calibrated;
  Adequacy const& before;
  NoiseLevel const& noise;
  Selection const& selection;
  std::vector<ParameterFinding> const& parameters;
  double smooth_explained = 0;
};

/// Share of the structure that the active candidates take away.
double explained_share(Structure const& before, Structure const& after);

/// Verdict, sentence and groups of a diagnosis whose figures stand already.
void reach_verdict(Evidence const& evidence, Diagnosis& diagnosis);

}  // namespace layerloop::validation
