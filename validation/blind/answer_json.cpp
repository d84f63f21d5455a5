#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/json_number.hpp"
#include "validation/blind/scenario.hpp"

namespace layerloop::validation {
namespace {

std::array<std::string, 10> const letters{"a", "c1", "c2", "d", "e", "f", "g", "h", "i", "r"};

std::vector<double> numbers(nlohmann::json const& list) {
  std::vector<double> all;
  for (nlohmann::json const& one : list) all.push_back(number_or_nan(one));
  return all;
}

}  // namespace

std::string const& letter_of(ScenarioClass kind) { return letters.at(static_cast<std::size_t>(kind)); }

double Answer::visibility() const { return visibilities.empty() ? 0 : *std::ranges::min_element(visibilities); }

void to_json(nlohmann::json& json, Answer const& answer) {
  nlohmann::json causes = nlohmann::json::array();
  for (HiddenCause const& cause : answer.causes)
    causes.push_back({{"name", cause.name},
                      {"strength", cause.strength},
                      {"from", cause.from},
                      {"label", cause.label},
                      {"other_form", cause.other_form}});
  json = {{"id", answer.id},
          {"class", letter_of(answer.kind)},
          {"text", answer.text},
          {"causes", causes},
          {"visibilities", answer.visibilities},
          {"strengths", answer.strengths},
          {"largest_cosine", answer.largest_cosine},
          {"nearest", answer.nearest},
          {"variables", answer.variables},
          {"quantities", answer.quantities},
          {"calibration", answer.calibration},
          {"truth", answer.truth}};
}

void from_json(nlohmann::json const& json, Answer& answer) {
  std::string const letter = json.at("class");
  answer.kind = static_cast<ScenarioClass>(std::ranges::find(letters, letter) - letters.begin());
  answer.causes.clear();
  for (nlohmann::json const& cause : json.at("causes"))
    answer.causes.push_back({cause.at("name"), cause.at("strength"), cause.at("from"), cause.at("label"),
                             cause.value("other_form", false)});
  json.at("id").get_to(answer.id);
  json.at("text").get_to(answer.text);
  answer.visibilities = numbers(json.at("visibilities"));
  answer.strengths = numbers(json.at("strengths"));
  answer.largest_cosine = number_or_nan(json.at("largest_cosine"));
  json.at("nearest").get_to(answer.nearest);
  json.at("variables").get_to(answer.variables);
  json.at("quantities").get_to(answer.quantities);
  json.at("calibration").get_to(answer.calibration);
  json.at("truth").get_to(answer.truth);
}

}  // namespace layerloop::validation
