#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "coupling/build_state.hpp"

namespace layerloop::coupling {

/// Writes checkpoint_NNNN.h5 and, after it, its digest checkpoint_NNNN.xxh3; keeps the two newest. Root rank only.
/// `case_text` is resolved_toml of the case, so that another case cannot be resumed by mistake.
void save_checkpoint(std::filesystem::path const& folder, BuildState const& state, std::string const& case_text);

/// The newest checkpoint in the folder whose digest is right; nothing when there is none. `skipped` names the damaged
/// ones. \throws InputError the checkpoint belongs to another case (only run.layers may differ)
std::optional<BuildState> load_newest_checkpoint(std::filesystem::path const& folder, std::string const& case_text,
                                                 std::string& skipped);

}  // namespace layerloop::coupling
