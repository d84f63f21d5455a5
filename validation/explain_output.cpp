#include "validation/explain_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_number.hpp"
#include "core/write_file.hpp"
#include "validation/display.hpp"
#include "validation/explain_page.hpp"
#include "validation/explain_tables.hpp"

namespace layerloop::validation {
namespace {

using nlohmann::json;

constexpr std::size_t shown_patterns = 3, shown_limits = 4, shown_candidates = 5;

json finding(CandidateFinding const& effect) {
  return {
      {"name", effect.name},   {"strength", number(effect.strength)}, {"u_strength", number(effect.u_strength)},
      {"z", number(effect.z)}, {"evidence", number(effect.evidence)}, {"kept_fraction", number(effect.kept_fraction)},
      {"group", effect.group}};
}

json candidate(CandidateFinding const& effect) {
  static constexpr std::array stages{"dem", "laser", "heat", "solid"};
  static constexpr std::array kinds{"physics", "calibration", "numerics", "instrument"};
  json all = finding(effect);
  all["stage"] = stages.at(static_cast<std::size_t>(effect.stage));
  all["class"] = kinds.at(static_cast<std::size_t>(effect.kind));
  all["active"] = effect.active;
  all["detectable_strength"] = number(effect.detectable);
  all["chi2_after"] = number(effect.chi2_after);
  all["twins"] = effect.twins;
  if (!effect.not_testable.empty()) all["not_testable"] = effect.not_testable;
  return all;
}

json patterns(std::vector<PatternFinding> const& found) {
  json all = json::array();
  for (PatternFinding const& p : found) all.push_back({{"text", p.text}, {"z", number(p.z)}, {"p", number(p.p)}});
  return all;
}

json settings_of(Condition const& condition) {
  json all = json::object();
  for (auto const& [key, value] : condition.inputs) all[key] = value;
  for (auto const& [key, word] : condition.words) all[key] = word;
  for (auto const& [key, label] : condition.labels) all[key] = label;
  return all;
}

json proposal(NextExperiment const& next) {
  json also = json::array();
  for (Condition const& condition : next.also_at) also.push_back(settings_of(condition));
  return {{"conditions", settings_of(next.condition)},
          {"also_at", also},
          {"quantity", next.quantity},
          {"together", next.together},
          {"replicates", next.replicates},
          {"separates", next.separates},
          {"separation", number(next.separation)},
          {"difference", number(next.difference)},
          {"u", number(next.u)},
          {"simulated", next.simulated}};
}

json thresholds(Thresholds const& t) {
  return {{"family_error", t.family_error},
          {"adequate_p", t.adequate_p},
          {"rival_gap", t.rival_gap},
          {"drop_z", t.drop_z},
          {"outlier_z", t.outlier_z},
          {"outlier_share", t.outlier_share},
          {"noisy_scale", t.noisy_scale},
          {"large_pull", t.large_pull},
          {"whole", t.whole},
          {"structure_p", t.structure_p},
          {"several_p", t.several_p},
          {"twin_cosine", t.twin_cosine},
          {"most_effects", t.most_effects},
          {"refitted_candidates", t.refitted_candidates}};
}

json definitions() {
  return {
      {"evidence", "natural logarithm of the Bayes factor of this candidate against nothing"},
      {"z", "signal of the candidate in what calibration leaves, in standard deviations"},
      {"kept_fraction", "share of the candidate's signature that calibration cannot swallow"},
      {"strength", "on top of what the case holds; 0: the case as it is"},
      {"u_strength", "one standard deviation"},
      {"chi2_base", "of the case as it stands"},
      {"chi2_before", "after calibration"},
      {"chi2_after", "with the effects of the verdict, calibrated anew"},
      {"explained",
       "share of the structure (squared scores of all smooth patterns beyond noise) that the effects take away"},
      {"smooth_explained", "the same of any smooth correction, each condition predicted from all others"},
      {"parameters", "value: with the effects; calibrated_value: without them"},
      {"model_runs", "passes over all conditions of the study"},
      {"conditions", "of the next experiment, in SI units"},
  };
}

std::string wrapped(std::string const& text, std::string const& indent, std::size_t width = 100) {
  std::string lines, line = indent;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t const end = std::min(text.find(' ', at), text.size());
    std::string const word = text.substr(at, end - at);
    if (line.size() > indent.size() && line.size() + word.size() > width) lines += line + '\n', line = indent;
    line += (line.size() > indent.size() ? " " : "") + word;
    at = end + 1;
  }
  return lines + line + '\n';
}

std::string settings_in_words(Condition const& condition) {
  std::vector<std::string> words;
  for (auto const& [key, value] : condition.inputs) words.push_back(value_in_words(key, value));
  for (auto const& [key, word] : condition.words) words.push_back(key + " = " + word);
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string weight(double z) { return std::abs(z) < 6 ? "weak" : std::abs(z) < 10 ? "fair" : "strong"; }

std::string effect_lines(Diagnosis const& found) {
  std::string lines = fmt::format("  {:32} {:>20} {:>7} {:>9} {:>6}\n", "candidate", "strength", "z", "ln B", "kept");
  std::size_t shown = 0;
  for (CandidateFinding const& effect : found.effects) {
    if (!effect.not_testable.empty() || (!effect.active && shown >= shown_candidates)) continue;
    ++shown;
    lines += fmt::format("{} {:32} {:>20} {:7.1f} {:9.1f} {:5.0f}% {}\n", effect.active ? "*" : " ", effect.name,
                         fmt::format("{:.3g} +- {:.2g}", effect.strength, effect.u_strength), effect.z, effect.evidence,
                         100 * effect.kept_fraction, effect.active ? weight(effect.z) : "");
  }
  return shown ? lines : "";
}

}  // namespace

std::string measured_in_words(NextExperiment const& next) {
  std::string words = next.quantity;
  for (std::size_t k = 0; k < next.together.size(); ++k)
    words += (k + 1 < next.together.size() ? ", " : " and ") + next.together[k];
  return words;
}

std::string places_in_words(NextExperiment const& next) {
  std::string words = settings_in_words(next.condition);
  for (Condition const& condition : next.also_at) words += " and at " + settings_in_words(condition);
  return words;
}

std::string proposal_in_words(NextExperiment const& next) {
  bool const one = next.replicates == 1 && next.together.empty() && next.also_at.empty();
  return fmt::format("{} at {}: {} reading{}{} tell{} {} apart", measured_in_words(next), places_in_words(next),
                     next.replicates, next.replicates == 1 ? "" : "s",
                     next.together.empty() && next.also_at.empty() ? "" : " of each", one ? "s" : "",
                     fmt::join(next.separates, " and "));
}

std::string answer_in_words(Explanation const& explained) {
  Diagnosis const& found = explained.found;
  std::string text = fmt::format("VERDICT: {}\n{}", name_of(found.verdict), wrapped(found.sentence, "  "));
  text += fmt::format("  chi2 {:.1f} -> calibrated {:.1f} -> with the effects {:.1f} (dof {:.0f}, sigma {:.2f})\n",
                      found.chi2_base, found.chi2_before, found.chi2_after, found.dof, std::sqrt(found.sigma2));
  if (found.chi2_before > found.chi2_after)
    text += fmt::format("  of the structure they explain {:.0f} %; any smooth correction could reach {:.0f} %\n",
                        100 * found.explained, 100 * found.smooth_explained);
  text += effect_lines(found);
  for (ParameterFinding const& p : found.parameters)
    if (std::abs(p.pull) >= explained.thresholds.large_pull)
      text += fmt::format("  {} is pulled to {:.4g} +- {:.2g}, {:.1f} sd from what was known of it\n", p.name, p.value,
                          p.u, p.pull);
  auto const& left = found.patterns_after.empty() ? found.patterns_before : found.patterns_after;
  for (std::size_t k = 0; k < std::min(shown_patterns, left.size()); ++k)
    if (left[k].p < 0.05)
      text += fmt::format("  left over: {} (z {:.1f}, p {:.2g})\n", left[k].text, left[k].z, left[k].p);
  if (!found.outliers.empty()) {
    std::vector<std::string> ids;
    for (OutlierFinding const& outlier : found.outliers) ids.push_back(outlier.obs_id);
    text += fmt::format("  outliers: {}\n", fmt::join(ids, ", "));
  }
  std::vector<std::string> limits = explained.study.limits;
  limits.insert(limits.end(), found.limits.begin(), found.limits.end());
  for (std::size_t k = 0; k < std::min(shown_limits, limits.size()); ++k) text += wrapped("limit: " + limits[k], "  ");
  for (NextExperiment const& next : explained.next) {
    text += wrapped("MEASURE: " + proposal_in_words(next), "");
    break;
  }
  return text + fmt::format("{:.1f} passes over the data, {:.0f} s\n", found.passes, explained.wall_time);
}

json explain_summary(Explanation const& explained) {
  Diagnosis const& found = explained.found;
  json all{{"verb", "explain"},
           {"study", explained.study.name},
           {"version", LAYERLOOP_VERSION},
           {"seed", explained.seed},
           {"verdict", name_of(found.verdict)},
           {"sentence", found.sentence},
           {"effects", json::array()},
           {"candidates", json::array()},
           {"chi2_base", number(found.chi2_base)},
           {"chi2_before", number(found.chi2_before)},
           {"chi2_after", number(found.chi2_after)},
           {"dof", number(found.dof)},
           {"sigma2", number(found.sigma2)},
           {"explained", number(found.explained)},
           {"smooth_explained", number(found.smooth_explained)},
           {"model_runs", number(found.passes)},
           {"parameters", json::array()},
           {"outliers", json::array()},
           {"limits", found.limits},
           {"next", json::array()}};
  auto const& left = found.patterns_after.empty() ? found.patterns_before : found.patterns_after;
  all["pattern"] = left.empty() || left.front().p > explained.thresholds.family_error ? "" : left.front().text;
  all["patterns_before"] = patterns(found.patterns_before);
  all["patterns_after"] = patterns(found.patterns_after);
  for (CandidateFinding const& effect : found.effects) {
    if (effect.active) all["effects"].push_back(finding(effect));
    all["candidates"].push_back(candidate(effect));
  }
  for (std::size_t k = 0; k < found.parameters.size(); ++k) {
    ParameterFinding const& p = found.parameters[k];
    Eigen::VectorXd const& calibrated = found.calibrated.calibration;
    auto const at = static_cast<Eigen::Index>(k);
    all["parameters"].push_back({{"name", p.name},
                                 {"mean", number(p.mean)},
                                 {"sd", number(p.sd)},
                                 {"value", number(p.value)},
                                 {"u", number(p.u)},
                                 {"pull", number(p.pull)},
                                 {"calibrated_value", number(at < calibrated.size() ? calibrated[at] : p.value)}});
  }
  for (OutlierFinding const& outlier : found.outliers)
    all["outliers"].push_back({{"obs_id", outlier.obs_id}, {"z", number(outlier.z)}});
  for (std::string const& limit : explained.study.limits) all["limits"].push_back(limit);
  for (NextExperiment const& next : explained.next) all["next"].push_back(proposal(next));
  all["provenance"] = {{"sha256", explained.sha256},
                       {"thresholds", thresholds(explained.thresholds)},
                       {"candidates_tried", explained.candidates.size()},
                       {"z_critical", number(found.z_critical)},
                       {"pattern_critical", number(found.pattern_critical)}};
  all["wall_time"] = {{"total", explained.wall_time}};
  all["definitions"] = definitions();
  return all;
}

void write_explanation(std::filesystem::path const& folder, Explanation const& explained) {
  write_explain_tables(folder, explained);
  write_file(folder / "report.html", explain_page(explained));
  write_file(folder / "summary.json", explain_summary(explained).dump(2) + "\n");
}

std::string nothing_to_separate(Explanation const& explained) {
  std::string const name = name_of(explained.found.verdict);
  if (explained.found.verdict == Verdict::GROUP)
    return fmt::format("{}: within the range of these conditions no measurement of these quantities tells them apart",
                       name);
  return fmt::format("{}: no candidates are left to be told apart", name);
}

void write_proposals(std::filesystem::path const& folder, Explanation const& explained) {
  json summary{{"verb", "next"},
               {"study", explained.study.name},
               {"version", LAYERLOOP_VERSION},
               {"verdict", name_of(explained.found.verdict)},
               {"next", json::array()},
               {"model_runs", number(explained.found.passes)}};
  for (NextExperiment const& next : explained.next) summary["next"].push_back(proposal(next));
  write_explain_tables(folder, explained);
  write_file(folder / "report.html", next_page(explained));
  write_file(folder / "summary.json", summary.dump(2) + "\n");
}

ReadExplanation read_explanation(std::filesystem::path const& summary) {
  std::filesystem::path const path = std::filesystem::is_directory(summary) ? summary / "summary.json" : summary;
  json const all = json::parse(read_file(path), nullptr, false);
  if (all.is_discarded() || !all.is_object() || all.value("verb", "") != "explain")
    throw InputError(
        fmt::format("{}: not a summary of explain (no \"verb\": \"explain\" in it) give --from the "
                    "summary.json that `layerloop explain` wrote",
                    path.string()));
  ReadExplanation read{.verdict = all.at("verdict"),
                       .sentence = all.at("sentence"),
                       .addition = {},
                       .groups = {},
                       .pattern = all.at("pattern")};
  for (json const& effect : all.at("effects")) {
    read.addition.effects.push_back(
        {effect.at("name"), number_or_nan(effect.at("strength")), number_or_nan(effect.at("u_strength"))});
    read.groups.push_back(effect.at("group"));
  }
  for (json const& p : all.at("parameters")) {
    read.addition.calibration_without[p.at("name")] = number_or_nan(p.at("calibrated_value"));
    read.addition.calibration_with[p.at("name")] = number_or_nan(p.at("value"));
  }
  read.addition.sigma2 = number_or_nan(all.at("sigma2"));
  return read;
}

}  // namespace layerloop::validation
