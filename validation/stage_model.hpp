#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "core/communicator.hpp"
#include "validation/candidate.hpp"
#include "validation/model.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

struct StageModelOptions {
  std::filesystem::path cache;  ///< what was computed stays here, by content
  std::int64_t beds = 1;        ///< independent seeds that are averaged, where a bed is involved
  bool quiet = false;
};

/// The stages of this program under the conditions of a study: spread, trace, melt, pile and plate as its quantities
/// need. A stage runs again only when something that it reads has changed. \throws InputError a condition does not make
/// a good case, before anything computes
std::unique_ptr<Model> stage_model(Study const& study, std::vector<Candidate> const& candidates,
                                   StageModelOptions const& options, Communicator const& comm);

}  // namespace layerloop::validation
