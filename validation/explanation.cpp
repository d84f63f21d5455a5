#include "validation/explanation.hpp"

namespace layerloop::validation {

Explanation explain(Study study, Model& model, std::vector<Candidate> candidates,
                    std::vector<Untestable> const& untestable, Thresholds const& thresholds, std::uint64_t seed) {
  Diagnosis found = diagnose(study, model, candidates, thresholds, seed);
  std::vector<Observation> kept;
  for (std::size_t const row : found.table.rows) kept.push_back(study.observations[row]);
  study.observations = std::move(kept);
  study.limits.clear();  // the diagnosis tells them, and more
  for (Untestable const& effect : untestable) {
    CandidateFinding& finding = found.effects.emplace_back();
    finding.name = effect.name;
    finding.not_testable = effect.why;
  }
  return {.study = std::move(study),
          .candidates = std::move(candidates),
          .found = std::move(found),
          .thresholds = thresholds,
          .seed = seed};
}

}  // namespace layerloop::validation
