#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "core/effect_catalogue.hpp"

namespace layerloop::validation {

/// One thing that every effect of the catalogue has to hold.
struct EffectCheck {
  std::string name;
  std::optional<bool> passed;  ///< nothing: it is only told
  std::string words;           ///< what was found
};

/// A figure of the layer that the effect moves, by strength.
struct ProbedFigure {
  std::string name;
  double base = 0, u_base = 0;    ///< without the effect, and the standard error of that [SI]
  std::vector<double> change, u;  ///< by strength: mean over the seeds, all with the seeds of the base [SI]
};

struct EffectReport {
  std::vector<EffectCheck> checks;
  std::vector<double> strengths;      ///< that were probed
  std::vector<ProbedFigure> figures;  ///< those that moved, by change over scatter
  bool passed() const;
};

/// A small case on which the effect can act.
struct EffectTrial {
  std::function<Case(std::vector<std::string> const& settings)> read;
  int seeds = 1;  ///< over which the probes are averaged
};

/// The built-in trial of an effect: of grains, a layer of some hundred; of light or heat, a track on a bare plate; of
/// what powder or a layer below must be there for, two layers with two short tracks each. \param settings  further
/// --set options
EffectTrial trial_of(Effect const& effect, std::vector<std::string> const& settings = {});
/// The same on a case of the user's.
EffectTrial trial_of(Effect const& effect, std::string const& case_file, std::vector<std::string> const& settings);

/// Runs the case with and without an effect. Checks that strength 0 leaves every number of the run as it is to the bit;
/// that a probe moves a figure, and further at a higher strength (within the scatter over seeds); that a run repeats
/// itself, also with other threads. Tells how far the effect is from linear, and what it costs. \note Collective
EffectReport test_effect(Effect const& effect, EffectTrial const& trial, Communicator const& comm);

}  // namespace layerloop::validation
