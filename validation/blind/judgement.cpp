#include "validation/blind/judgement.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace layerloop::validation {

bool Judgement::names_physics() const {
  static std::vector<std::string> const claims{"IDENTIFIED", "GROUP", "IDENTIFIED_FORM_IMPERFECT", "PARTIAL"};
  return std::ranges::find(claims, verdict) != claims.end() &&
         std::ranges::any_of(named, [](Named const& one) { return one.is_physics; });
}

bool Judgement::contains(std::string const& name) const {
  return std::ranges::any_of(named, [&](Named const& one) {
    return one.name == name || std::ranges::find(one.group, name) != one.group.end();
  });
}

std::size_t Judgement::set_size() const {
  if (named.empty()) return 0;
  std::vector<std::string> all = named.front().group;
  all.push_back(named.front().name);
  std::ranges::sort(all);
  return static_cast<std::size_t>(std::unique(all.begin(), all.end()) - all.begin());
}

void to_json(nlohmann::json& json, Judgement const& judgement) {
  nlohmann::json named = nlohmann::json::array();
  for (Judgement::Named const& one : judgement.named)
    named.push_back({{"name", one.name},
                     {"physics", one.is_physics},
                     {"strength", one.strength},
                     {"u_strength", one.u_strength},
                     {"group", one.group}});
  json = {{"verdict", judgement.verdict},
          {"named", named},
          {"patterns", judgement.patterns},
          {"sigma2", judgement.sigma2},
          {"model_runs", judgement.passes},
          {"calibrated", judgement.calibrated},
          {"final_calibration", judgement.final_calibration},
          {"final_strengths", judgement.final_strengths}};
}

void from_json(nlohmann::json const& json, Judgement& judgement) {
  json.at("verdict").get_to(judgement.verdict);
  for (nlohmann::json const& one : json.at("named"))
    judgement.named.push_back({one.at("name"), one.at("physics"), one.at("strength").get<double>(),
                               one.at("u_strength").get<double>(), one.at("group")});
  json.at("patterns").get_to(judgement.patterns);
  json.at("sigma2").get_to(judgement.sigma2);
  json.at("model_runs").get_to(judgement.passes);
  json.at("calibrated").get_to(judgement.calibrated);
  json.at("final_calibration").get_to(judgement.final_calibration);
  json.at("final_strengths").get_to(judgement.final_strengths);
}

std::vector<Candidate> known_candidates(World const& world, Study const& study,
                                        std::vector<std::string> const& withheld) {
  std::vector<Candidate> candidates = world.candidates(study);
  std::erase_if(candidates, [&](Candidate const& c) { return std::ranges::find(withheld, c.name) != withheld.end(); });
  return candidates;
}

Judgement judge(World const& world, Study const& training, std::vector<std::string> const& withheld,
                Thresholds const& thresholds, std::uint64_t seed) {
  std::vector<Candidate> const candidates = known_candidates(world, training, withheld);
  auto const model = world.model(training, candidates);
  Diagnosis const found = diagnose(training, *model, candidates, thresholds, seed);
  Judgement judgement{.verdict = name_of(found.verdict),
                      .named = {},
                      .patterns = {},
                      .sigma2 = found.sigma2,
                      .passes = found.passes,
                      .calibrated = {},
                      .final_calibration = {},
                      .final_strengths = {}};
  for (CandidateFinding const& effect : found.effects)
    if (effect.active)
      judgement.named.push_back(
          {effect.name, effect.kind == EffectClass::physics, effect.strength, effect.u_strength, effect.group});
  constexpr std::size_t shown = 3;
  for (PatternFinding const& pattern : found.patterns_after)
    if (judgement.patterns.size() < shown) judgement.patterns.push_back(pattern.text);
  auto const list = [](Eigen::VectorXd const& values) { return std::vector<double>(values.begin(), values.end()); };
  judgement.calibrated = list(found.calibrated.calibration);
  judgement.final_calibration = list(found.final_point.calibration);
  judgement.final_strengths = list(found.final_point.strengths);
  return judgement;
}

}  // namespace layerloop::validation
