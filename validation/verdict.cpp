#include <array>

#include "validation/diagnosis.hpp"

namespace layerloop::validation {

std::string const& name_of(Verdict verdict) {
  static std::array<std::string, 11> const names{
      "CONSISTENT", "CALIBRATION", "NOISE",      "IDENTIFIED", "GROUP",     "IDENTIFIED_FORM_IMPERFECT",
      "PARTIAL",    "UNKNOWN",     "CONFOUNDED", "NUMERICS",   "INSTRUMENT"};
  return names.at(static_cast<std::size_t>(verdict));
}

}  // namespace layerloop::validation
