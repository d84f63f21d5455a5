#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "validation/blind/world.hpp"

namespace layerloop::validation {

/// "a", "c1", ...
std::string const& letter_of(ScenarioClass kind);

/// What is sealed.
struct Answer {
  std::string id;
  ScenarioClass kind = ScenarioClass::nothing;
  std::string text;                                ///< what is hidden, in words
  std::vector<HiddenCause> causes;                 ///< physics, or what this is about
  std::vector<double> visibilities;                ///< lambda of each cause, under the stated uncertainties
  std::vector<double> strengths;                   ///< in the catalogue's form: what comes closest
  double largest_cosine = 0;                       ///< of the first cause with any other candidate
  std::string nearest;                             ///< that candidate
  std::vector<std::string> variables, quantities;  ///< of the right pattern, one of each
  std::vector<double> calibration;                 ///< true values
  std::map<std::string, double> truth;             ///< by obs_id, without errors [SI]

  double visibility() const;  ///< the least of its causes; 0 without
};

void to_json(nlohmann::json& json, Answer const& answer);
void from_json(nlohmann::json const& json, Answer& answer);

/// A study with something hidden in it.
struct Scenario {
  Study study;                        ///< all rows, with values
  std::vector<std::string> withheld;  ///< candidates that the analysis must not know
  Answer answer;
};

/// A pure function of its arguments. \param secret  seed of everything that is hidden
Scenario draw_scenario(World const& world, ScenarioClass kind, std::string const& id, std::uint64_t secret);

}  // namespace layerloop::validation
