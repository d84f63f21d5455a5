#include "validation/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <set>

namespace layerloop::validation {
namespace {

constexpr double least_kept_beside_label = 0.1;  // of a signature, below which it varies with a label alone

std::set<std::string> labels_of(Study const& study) {
  std::set<std::string> all;
  for (Condition const& c : study.conditions)
    for (auto const& [label, level] : c.labels) all.insert(label);
  return all;
}

Eigen::MatrixXd beside(Eigen::MatrixXd const& a, Eigen::MatrixXd const& b) {
  Eigen::MatrixXd both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

/// Columns of a label in the frame of the diagnosis.
Eigen::MatrixXd of_label(Evidence const& evidence, std::string const& label) {
  ResidualFrame const& frame = evidence.bench.frame;
  return frame.without_spared(label_columns(
      frame.study(), label, at_observations(frame.study(), evidence.calibrated.prediction.value), frame.whiten()));
}

/// A label that could have brought about what speaks for the best candidate: its signature has next to nothing within
/// the levels of the label, or the data within them do not bear it out.
std::string confounding_label(Evidence const& evidence) {
  Fit const& before = evidence.calibrated;
  Fit const& after = evidence.selection.fit;
  double const sigma = std::sqrt(evidence.bench.sigma2);
  for (std::string const& label : labels_of(evidence.bench.frame.study())) {
    Eigen::MatrixXd const columns = of_label(evidence, label);
    if (columns.cols() == 0) continue;
    Projection const plain = evidence.bench.projection(before);
    Projection const project(evidence.bench.frame.size(), beside(before.jacobian, columns));
    Eigen::VectorXd const change = evidence.bench.frame.without_spared(before.residual - after.residual);
    double const whole = plain(change).squaredNorm(), within = project(change).squaredNorm();
    if (within < least_kept_beside_label * whole) return label;
    double const expected = std::sqrt(within) / sigma;
    double const seen = project(change).col(0).dot(before.residual) / std::sqrt(within) / sigma;
    if (expected > 5 && seen < 0.4 * expected) return label;
  }
  return "";
}

/// A label whose levels alone explain everything, where no candidate did.
std::string sufficient_label(Evidence const& evidence) {
  for (std::string const& label : labels_of(evidence.bench.frame.study())) {
    Eigen::MatrixXd const columns = of_label(evidence, label);
    if (columns.cols() == 0) continue;
    Fit wider = evidence.calibrated;
    wider.jacobian = beside(wider.jacobian, columns);
    if (adequacy_of(evidence.bench, wider).ok) return label;
  }
  return "";
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
    Fit wider = fit;
    wider.jacobian = beside(fit.jacobian, evidence.bench.frame.without_spared(evidence.bench.frame.whiten()(units)));
    if (adequacy_of(evidence.bench, wider).ok) return study.conditions[c].id;
  }
  return "";
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
  if (std::string const label = sufficient_label(evidence); !label.empty())
    return say(diagnosis, Verdict::CONFOUNDED,
               fmt::format("What the model misses differs from {0} to {0} and not within: these data cannot tell a "
                           "physical cause from the {0} ({1}).",
                           label, top_patterns(now)));
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
  bool const adequate = now.ok || !limit.gates;
  bool const beaten = evidence.smooth_explained > diagnosis.explained + 0.1;
  if (!adequate && (diagnosis.explained <= limit.part || beaten))
    return say(
        diagnosis, diagnosis.explained <= limit.part ? Verdict::UNKNOWN : Verdict::PARTIAL,
        fmt::format("No known effect explains this: {} takes {:.0f} % of the excess, a smooth correction {:.0f} %. "
                    "What is left looks like: {}.",
                    names, 100 * diagnosis.explained, 100 * evidence.smooth_explained, top_patterns(now)));
  if (has_class(EffectClass::numerics))
    return say(diagnosis, Verdict::NUMERICS,
               fmt::format("The discretisation is at fault: {}. Refine it first.", names));
  if (has_class(EffectClass::instrument))
    return say(diagnosis, Verdict::INSTRUMENT,
               fmt::format("The measuring is at fault: {}. Mend or calibrate it first.", names));
  if (std::string const label = confounding_label(evidence); !label.empty())
    return say(
        diagnosis, Verdict::CONFOUNDED,
        fmt::format("{} would explain it, but what speaks for it varies with the {} alone: measure it within one {}.",
                    names, label, label));
  std::vector<std::string> const all = members(diagnosis);
  if (all.size() > active_names(diagnosis).size())
    return say(diagnosis, Verdict::GROUP,
               fmt::format("One of {{{}}} is missing; these data cannot tell which.", fmt::join(all, ", ")));
  if (has_class(EffectClass::calibration))
    return say(diagnosis, Verdict::CALIBRATION, fmt::format("An input is off: {}. Measure it independently.", names));
  if (adequate) return say(diagnosis, Verdict::IDENTIFIED, fmt::format("{} is missing.", names));
  if (diagnosis.explained > limit.whole)
    return say(diagnosis, Verdict::IDENTIFIED_FORM_IMPERFECT,
               fmt::format("{} is missing; its form here is not quite that of the measurements ({}).", names,
                           top_patterns(now)));
  say(diagnosis, Verdict::PARTIAL,
      fmt::format("This resembles {}, which takes {:.0f} % of the excess. What is left looks like: {}.", names,
                  100 * diagnosis.explained, top_patterns(now)));
}

}  // namespace

std::string const& name_of(Verdict verdict) {
  static std::array<std::string, 11> const names{
      "CONSISTENT", "CALIBRATION", "NOISE",      "IDENTIFIED", "GROUP",     "IDENTIFIED_FORM_IMPERFECT",
      "PARTIAL",    "UNKNOWN",     "CONFOUNDED", "NUMERICS",   "INSTRUMENT"};
  return names.at(static_cast<std::size_t>(verdict));
}

double explained_share(Adequacy const& before, Adequacy const& after) {
  double const excess = before.chi2 - before.dof;
  return excess > 0 ? std::clamp(1 - std::max(0.0, after.chi2 - after.dof) / excess, 0.0, 1.0) : 1.0;
}

void reach_verdict(Evidence const& evidence, Diagnosis& diagnosis) {
  if (evidence.selection.fit.active.empty()) {
    verdict_without_candidate(evidence, diagnosis);
  } else {
    verdict_with_candidates(evidence, diagnosis);
  }
}

}  // namespace layerloop::validation
