#pragma once
#include <string>

#include "core/user_effect.hpp"

namespace layerloop::coupling {

/// For outputs: version, and every library of effects with its hash.
inline std::string program_version() { return LAYERLOOP_VERSION + plugin_note(); }

}  // namespace layerloop::coupling
