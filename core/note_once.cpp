#include "core/note_once.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <set>

namespace layerloop {

void note_once(std::string const& text) {
  static std::set<std::string> said;
  if (said.insert(text).second) fmt::print(stderr, "note: {}\n", text);
}

}  // namespace layerloop
