#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "validation/explanation.hpp"

namespace layerloop::validation {

/// The same model under other conditions, with the candidates of the explanation.
using ModelOf = std::function<std::unique_ptr<Model>(Study const&)>;

/// What to measure next, best first. Rivals of a GROUP: where their predictions differ most once the worse one has been
/// refitted to the new readings too (T-optimality; Atkinson & Fedorov, Biometrika 62 (1975) 57), over a grid of
/// conditions between those of the study, of every quantity that its runs give, and of all together that the study
/// reads; Gaussian processes screen, true runs judge the best three places and the corners of the range; where no place
/// will do alone, up to three together. UNKNOWN, PARTIAL and CONFOUNDED: the extremes of what is left over, again.
/// Otherwise nothing. \param model  of the explanation's study
std::vector<NextExperiment> next_experiments(Explanation const& explained, Model& model, ModelOf const& model_of);

/// The grid of conditions that is searched: those of the study, and places between their extremes.
/// \param origin  condition of the study that lent labels, words and the inputs that do not vary, by condition
std::vector<Condition> condition_grid(Study const& study, std::vector<std::size_t>& origin);

}  // namespace layerloop::validation
