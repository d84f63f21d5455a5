#pragma once
#include "apps/verbs.hpp"
#include "validation/explanation.hpp"

namespace layerloop::apps {

/// The diagnosis of a study with its proposals; what its cache holds is not computed again. \param verb  folder of the
/// results in the study, when none was given \throws InputError, FileError, PhysicsError
validation::Explanation explained(StudyOptions& options, std::string const& verb);

}  // namespace layerloop::apps
