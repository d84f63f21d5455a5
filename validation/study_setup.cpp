#include "validation/study_setup.hpp"

#include <algorithm>

#include "validation/condition_case.hpp"
#include "validation/error_model.hpp"
#include "validation/stage_run.hpp"

namespace layerloop::validation {

Case first_case(Study const& study) {
  ConditionCases const cases(study);
  Verb verb = Verb::spread;
  for (Observable const& observable : study.observables) verb = std::max(verb, verb_for(observable, cases.scans()));
  return cases.make(cases.settings(study.observables.front().condition, prior_means(study)), verb);
}

StudySetup set_up(Study study, Study const& like, StageModelOptions const& options, Communicator const& comm) {
  Case const base = first_case(like);
  StudySetup at_hand{.study = std::move(study),
                     .candidates = candidates_for(like, base),
                     .untestable = untestable_effects(like, base),
                     .model = nullptr};
  at_hand.model = stage_model(at_hand.study, at_hand.candidates, options, comm);
  return at_hand;
}

}  // namespace layerloop::validation
