#pragma once
#include <memory>

#include "validation/candidates.hpp"
#include "validation/stage_model.hpp"
#include "validation/study_file.hpp"

namespace layerloop::validation {

/// A study as the verbs use it: what may be the matter, and the stages under its conditions.
struct StudySetup {
  Study study;
  std::vector<Candidate> candidates;
  std::vector<Untestable> untestable;
  std::unique_ptr<Model> model;
};

/// The stages for a study that was read. The candidates are those of `like`, so that train and holdout share a mesh.
/// \throws InputError
StudySetup set_up(Study study, Study const& like, StageModelOptions const& options, Communicator const& comm);

/// The case of a study under its first condition. \throws InputError
Case first_case(Study const& study);

}  // namespace layerloop::validation
