#include "coupling/verb.hpp"

#include <algorithm>

namespace layerloop::coupling {

std::vector<std::string> const& verb_names() {
  static std::vector<std::string> const names{"spread", "calibrate", "absorb", "melt", "run"};
  return names;
}

std::string const& name_of(Verb verb) { return verb_names().at(static_cast<std::size_t>(verb)); }

std::optional<Verb> verb_named(std::string const& name) {
  auto const found = std::ranges::find(verb_names(), name);
  if (found == verb_names().end()) return std::nullopt;
  return static_cast<Verb>(found - verb_names().begin());
}

Process process_of(Verb verb) {
  switch (verb) {
    case Verb::spread:
      return Process::spreading;
    case Verb::calibrate:
      return Process::calibrating;
    case Verb::absorb:
      return Process::absorbing;
    case Verb::melt:
      return Process::exposing;
    case Verb::run:
      return Process::melting;
  }
  return Process::melting;
}

bool spreads_first(Verb verb, Case const& checked) {
  return verb == Verb::spread || ((verb == Verb::melt || verb == Verb::absorb) && checked.has_machine());
}

}  // namespace layerloop::coupling
