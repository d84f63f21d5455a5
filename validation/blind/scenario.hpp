#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "validation/blind/world.hpp"

namespace layerloop::validation {

/// What kind of thing is hidden, and with it what a right answer is.
enum class ScenarioClass {
  one_effect,         ///< a: that effect, or its group
  withheld_effect,    ///< c1: an effect that the candidates lack: UNKNOWN
  foreign_cause,      ///< c2: something that no catalogue holds: UNKNOWN with the right pattern
  nothing,            ///< d: no claim
  wrong_calibration,  ///< e: 1 to 5 numbers 2 to 4 prior deviations off: no physics
  two_effects,        ///< f: both
  twins,              ///< g: two candidates that look the same: GROUP
  bad_noise,          ///< h: outliers, understated noise, a systematic error left out: no physics
  not_physics,        ///< i: cells, offsets, scales: named as such
  real_life           ///< r: wrong uncertainties, an unlabelled lot or focus jump, biased inputs: no physics
};
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

/// Which class the n-th scenario of a set has: of a hundred, 20 a, 7 c1, 7 c2, 10 d, 8 e, 6 f, 4 g, 5 i, and a third
/// with what real data carry, 9 h and 24 r.
ScenarioClass class_of(std::size_t number);

}  // namespace layerloop::validation
