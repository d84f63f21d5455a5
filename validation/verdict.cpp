#include "validation/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

namespace layerloop::validation {
namespace {

constexpr double alone_z = 5;  // of one or two readings, that may as well be the tip of a pattern

Fit with_columns(Fit fit, Eigen::MatrixXd const& columns) {
  fit.jacobian = beside(fit.jacobian, columns);
  return fit;
}

/// What a jump reaches, counted against it the numbers that it fits and how many jumps of its kind were tried
/// (Akaike; Schwarz).
double jump_score(Evidence const& evidence, Jump const& jump, std::vector<Jump> const& all) {
  Adequacy const with = chi2_of(evidence.bench, with_columns(evidence.calibrated, jump.columns));
  auto const same_kind = std::ranges::count(all, jump.label, &Jump::label);
  return with.chi2 + 2 * (evidence.before.dof - with.dof) + 2 * std::log(static_cast<double>(same_kind));
}

/// A change without physics that takes as much away as the candidates do: these data cannot tell one from the other. A
/// label is a cause that is known to be there; one that only the order of acquisition tells must do better.
std::optional<Jump> rival_jump(Evidence const& evidence) {
  double const named = evidence.selection.adequacy.chi2 + 2 * (evidence.before.dof - evidence.selection.adequacy.dof);
  std::vector<Jump> const all = jumps_in(evidence.bench.frame, evidence.calibrated);
  std::optional<Jump> best;
  double least = std::numeric_limits<double>::infinity();
  for (Jump const& jump : all) {
    double const score = jump_score(evidence, jump, all);
    double const allowed = jump.label == order_of_acquisition ? named - evidence.bench.thresholds.rival_gap
                                                              : named + evidence.bench.thresholds.rival_gap;
    if (score < std::min(least, allowed)) best = jump, least = score;
  }
  return best;
}

/// The label one of whose levels explains everything best by itself, where no candidate did.
std::optional<Jump> sufficient_level(Evidence const& evidence) {
  std::vector<Jump> const all = jumps_in(evidence.bench.frame, evidence.calibrated);
  std::optional<Jump> best;
  double least = std::numeric_limits<double>::infinity();
  for (Jump const& jump : all) {
    if (jump.label == order_of_acquisition) continue;
    if (!adequacy_of(evidence.bench, with_columns(evidence.calibrated, jump.columns)).ok) continue;
    if (double const score = jump_score(evidence, jump, all); score < least) best = jump, least = score;
  }
  return best;
}

/// The condition without which no pattern is left, if there is one: not a pattern, then, but a reading gone wrong.
std::string lonely_condition(Evidence const& evidence, Fit const& fit) {
  Study const& study = evidence.bench.frame.study();
  if (study.conditions.size() < 8) return "";
  for (std::size_t c = 0; c < study.conditions.size(); ++c) {
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < study.observations.size(); ++i)
      if (study.observations[i].condition == c) rows.push_back(static_cast<Eigen::Index>(i));
    if (rows.empty()) continue;
    Eigen::MatrixXd units = Eigen::MatrixXd::Zero(evidence.bench.frame.size(), static_cast<Eigen::Index>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k) units(rows[k], static_cast<Eigen::Index>(k)) = 1;
    Eigen::MatrixXd const own = evidence.bench.frame.without_spared(evidence.bench.frame.whiten()(units));
    if (adequacy_of(evidence.bench, with_columns(fit, own)).ok) return study.conditions[c].id;
  }
  return "";
}

/// Readings without which calibration alone does, where each of them is out of all proportion: few and far, not a
/// smooth pattern that they bend towards themselves. Empty where that is not enough.
std::vector<OutlierFinding> sufficient_outliers(Evidence const& evidence) {
  Workbench const& bench = evidence.bench;
  auto const most = static_cast<std::size_t>(bench.thresholds.outlier_share * static_cast<double>(bench.frame.size()));
  Fit fit = evidence.calibrated;
  std::vector<OutlierFinding> found;
  std::set<std::pair<std::string, bool>> kinds;  // quantity and sign: all alike is a pattern
  while (found.size() + bench.frame.spared().size() < most) {
    Projection const project(bench.frame.size(), fit.jacobian);
    Eigen::VectorXd const left = project(fit.residual), diagonal = project.diagonal();
    Eigen::VectorXd z = Eigen::VectorXd::Zero(left.size());
    for (Eigen::Index i = 0; i < z.size(); ++i)
      if (diagonal[i] > 0.05) z[i] = left[i] / std::sqrt(diagonal[i] * bench.sigma2);
    Eigen::Index worst = 0;
    if (!(z.cwiseAbs().maxCoeff(&worst) > bench.thresholds.outlier_z)) return {};
    Observation const& seen = bench.frame.study().observations[static_cast<std::size_t>(worst)];
    found.push_back({seen.id, z[worst]});
    kinds.insert({seen.quantity, z[worst] > 0});
    Eigen::MatrixXd const unit = Eigen::VectorXd::Unit(z.size(), worst);
    fit = with_columns(std::move(fit), bench.frame.without_spared(bench.frame.whiten()(unit)));
    if (!adequacy_of(bench, fit).ok) continue;
    bool const lopsided = found.size() > 2 && kinds.size() == 1;
    bool const far = found.size() > 2 || std::abs(found.back().z) > alone_z;
    return lopsided || !far ? std::vector<OutlierFinding>{} : found;
  }
  return {};
}

std::string top_patterns(Adequacy const& adequacy) {
  std::vector<std::string> texts;
  for (PatternFinding const& pattern : adequacy.patterns)
    if (texts.size() < 3 && std::abs(pattern.z) > 0.8 * adequacy.pattern_critical) texts.push_back(pattern.text);
  return texts.empty() ? "scatter without a pattern" : fmt::format("{}", fmt::join(texts, "; "));
}

std::vector<std::string> active_names(Diagnosis const& diagnosis) {
  std::vector<std::string> names;
  for (CandidateFinding const& found : diagnosis.effects)
    if (found.active) names.push_back(found.name);
  return names;
}

void say(Diagnosis& diagnosis, Verdict verdict, std::string sentence) {
  diagnosis.verdict = verdict;
  diagnosis.sentence = std::move(sentence);
}

/// Whether single readings are all that does not fit.
bool say_outliers(Evidence const& evidence, Diagnosis& diagnosis) {
  std::vector<OutlierFinding> const found = sufficient_outliers(evidence);
  if (found.empty()) return false;
  diagnosis.outliers.insert(diagnosis.outliers.end(), found.begin(), found.end());
  say(diagnosis, Verdict::NOISE,
      fmt::format("{} of {} readings do not fit, and without them nothing needs a cause. Repeat them.",
                  diagnosis.outliers.size(), evidence.bench.frame.size()));
  return true;
}

/// Whether one level of a label is all that differs.
bool say_level(Evidence const& evidence, Diagnosis& diagnosis, Adequacy const& now) {
  auto const jump = sufficient_level(evidence);
  if (!jump) return false;
  say(diagnosis, Verdict::CONFOUNDED,
      fmt::format(
          "{0} differs, and nothing within the {1}s: these data cannot tell a physical cause from the {1} ({2}).",
          jump->words, jump->label, top_patterns(now)));
  return true;
}

/// Nothing was chosen: is there anything to explain, and what does it look like?
void verdict_without_candidate(Evidence const& evidence, Diagnosis& diagnosis) {
  Thresholds const& limit = evidence.bench.thresholds;
  Adequacy const& now = evidence.selection.adequacy;
  if (now.ok || !limit.gates) {
    auto const pulled = std::ranges::max_element(
        evidence.parameters, {}, [](ParameterFinding const& parameter) { return std::abs(parameter.pull); });
    if (pulled != evidence.parameters.end() && std::abs(pulled->pull) >= limit.large_pull)
      return say(diagnosis, Verdict::CALIBRATION,
                 fmt::format("Calibration is off: {} wants {:.4g} +- {:.2g}, {:.1f} standard deviations from what was "
                             "known of it. Measure it independently.",
                             pulled->name, pulled->value, pulled->u, pulled->pull));
    if (evidence.noise.sigma2 > limit.noisy_scale || !evidence.noise.outliers.empty())
      return say(
          diagnosis, Verdict::NOISE,
          fmt::format("The measurements scatter {:.2f} times as much as their uncertainties say, with {} outlier(s); "
                      "there is no structure that would need a cause.",
                      std::sqrt(evidence.noise.sigma2), evidence.noise.outliers.size()));
    return say(diagnosis, Verdict::CONSISTENT, "Model and measurements agree within their uncertainties.");
  }
  if (say_outliers(evidence, diagnosis)) return;
  if (say_level(evidence, diagnosis, now)) return;
  if (std::string const alone = lonely_condition(evidence, evidence.selection.fit); !alone.empty())
    return say(diagnosis, Verdict::NOISE,
               fmt::format("Condition {} alone does not fit; without it nothing needs a cause. Repeat it.", alone));
  say(diagnosis, Verdict::UNKNOWN,
      fmt::format("No known effect explains this. What is left looks like: {}.", top_patterns(now)));
}

/// Members of the groups of all active candidates.
std::vector<std::string> members(Diagnosis const& diagnosis) {
  std::vector<std::string> all;
  for (CandidateFinding const& found : diagnosis.effects) {
    if (!found.active) continue;
    all.push_back(found.name);
    all.insert(all.end(), found.group.begin(), found.group.end());
  }
  return all;
}

void verdict_with_candidates(Evidence const& evidence, Diagnosis& diagnosis) {
  Thresholds const& limit = evidence.bench.thresholds;
  Adequacy const& now = evidence.selection.adequacy;
  std::string const names = fmt::format("{}", fmt::join(active_names(diagnosis), " and "));
  auto const has_class = [&](EffectClass kind) {
    return std::ranges::any_of(diagnosis.effects,
                               [&](auto const& found) { return found.active && found.kind == kind; });
  };
  std::size_t const count = evidence.selection.fit.active.size();
  // Several names fit many a shape: they must leave clearly nothing of it, or take nearly all.
  bool const shapeless = diagnosis.structure_after.p > (count > 1 ? limit.several_p : limit.structure_p);
  bool const adequate = (now.ok && shapeless) || !limit.gates;
  bool const beaten = evidence.smooth_explained > diagnosis.explained + 0.1;
  // As many effects as may be share out the shape of something else among them.
  bool const patchwork = limit.gates && static_cast<int>(count) >= limit.most_effects;
  // An input that would have to be as wrong as it can be, or a gauge that even then would not do.
  bool const far_off = limit.gates && std::ranges::any_of(evidence.selection.fit.active, [&](std::size_t k) {
                         Candidate const& candidate = evidence.bench.candidates[k];
                         double const strength = evidence.selection.fit.point.strengths[index(k)];
                         bool const counts = candidate.kind == EffectClass::calibration ||
                                             (candidate.kind == EffectClass::instrument && !adequate);
                         return counts && std::abs(strength) > 0.99 * candidate.largest;
                       });
  bool const weak = patchwork || far_off || (!adequate && (diagnosis.explained <= limit.whole || beaten));
  if (weak && (say_outliers(evidence, diagnosis) || say_level(evidence, diagnosis, evidence.before))) return;
  if (weak)
    return say(
        diagnosis, Verdict::UNKNOWN,
        fmt::format("No known effect explains this: {} takes {:.0f} % of the structure, a smooth correction {:.0f} %. "
                    "What is left looks like: {}.",
                    names, 100 * diagnosis.explained, 100 * evidence.smooth_explained, top_patterns(now)));
  if (adequate && has_class(EffectClass::numerics))
    return say(diagnosis, Verdict::NUMERICS,
               fmt::format("The discretisation is at fault: {}. Refine it first.", names));
  if (adequate && has_class(EffectClass::instrument))
    return say(diagnosis, Verdict::INSTRUMENT,
               fmt::format("The measuring is at fault: {}. Mend or calibrate it first.", names));
  if (auto const jump = rival_jump(evidence))
    return say(
        diagnosis, Verdict::CONFOUNDED,
        fmt::format("{} would explain it, but an offset of {} does so as well: measure it within one {}.", names,
                    jump->words, jump->label == order_of_acquisition ? "session, in random order" : jump->label));
  std::vector<std::string> const all = members(diagnosis);
  if (all.size() > active_names(diagnosis).size())
    return say(diagnosis, Verdict::GROUP,
               fmt::format("One of {{{}}} is missing; these data cannot tell which.", fmt::join(all, ", ")));
  if (adequate && has_class(EffectClass::calibration))
    return say(diagnosis, Verdict::CALIBRATION, fmt::format("An input is off: {}. Measure it independently.", names));
  if (adequate) return say(diagnosis, Verdict::IDENTIFIED, fmt::format("{} is missing.", names));
  if (!has_class(EffectClass::instrument) && !has_class(EffectClass::calibration))
    return say(diagnosis, Verdict::IDENTIFIED_FORM_IMPERFECT,
               fmt::format("{} is missing; its form here is not quite that of the measurements ({}).", names,
                           top_patterns(now)));
  say(diagnosis, Verdict::PARTIAL,
      fmt::format("This resembles {}, which takes {:.0f} % of the structure. What is left looks like: {}.", names,
                  100 * diagnosis.explained, top_patterns(now)));
}

}  // namespace

std::string const& name_of(Verdict verdict) {
  static std::array<std::string, 11> const names{
      "CONSISTENT", "CALIBRATION", "NOISE",      "IDENTIFIED", "GROUP",     "IDENTIFIED_FORM_IMPERFECT",
      "PARTIAL",    "UNKNOWN",     "CONFOUNDED", "NUMERICS",   "INSTRUMENT"};
  return names.at(static_cast<std::size_t>(verdict));
}

double explained_share(Structure const& before, Structure const& after) {
  return before.excess > 0 ? std::clamp(1 - after.excess / before.excess, 0.0, 1.0) : 1.0;
}

void reach_verdict(Evidence const& evidence, Diagnosis& diagnosis) {
  if (evidence.selection.fit.active.empty()) {
    verdict_without_candidate(evidence, diagnosis);
  } else {
    verdict_with_candidates(evidence, diagnosis);
  }
}

}  // namespace layerloop::validation
