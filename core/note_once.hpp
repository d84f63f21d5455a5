#pragma once
#include <string>

namespace layerloop {

/// Writes "note: ..." to stderr the first time that this process gets the text. Call on the root rank only, outside of
/// threads.
void note_once(std::string const& text);

}  // namespace layerloop
