#include "validation/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "validation/noise_level.hpp"
#include "validation/selection.hpp"
#include "validation/smooth_correction.hpp"
#include "validation/verdict.hpp"

namespace layerloop::validation {
namespace {

/// What the model has an answer for, and what was left out in words.
Study judged(Study const& given, Prediction const& prediction) {
  Study study = answered(given, prediction);
  auto const count = given.observations.size() - study.observations.size();
  if (count == 0) return study;
  study.limits.push_back(
      fmt::format("{} of {} readings have no prediction (nothing melts there, or a guard stopped the "
                  "run) and are left out",
                  count, given.observations.size()));
  if (study.observations.empty())
    throw PhysicsError(
        "the model has no answer for any of the measurements (nothing melts, or every run was stopped by "
        "a guard) look at one condition by itself");
  return study;
}

/// ln of the Bayes factor of a candidate against nothing, its strength half normal beforehand with its prior scale
/// (normal for a two-sided one), exact for a linear model. \param b  prior scale in standard deviations
double log_evidence(double z, double b, bool two_sided) {
  double const bayes = -0.5 * std::log1p(b * b) + 0.5 * z * z * b * b / (1 + b * b);
  if (two_sided) return bayes;
  double const tail = boost::math::cdf(boost::math::normal(), z * b / std::sqrt(1 + b * b));
  return std::numbers::ln2 + std::log(std::max(tail, 1e-300)) + bayes;
}

/// Pull of every calibration number at a fit. One that stands at its bound wants to go farther, however well the data
/// know it there.
std::vector<ParameterFinding> parameters_of(Study const& study, Refit const& refit, Fit const& fit) {
  Eigen::VectorXd const u = refit.uncertainty(fit);
  std::vector<ParameterFinding> all;
  for (std::size_t k = 0; k < study.calibration.size(); ++k) {
    CalibrationParameter const& number = study.calibration[k];
    double const value = fit.point.calibration[index(k)];
    double const own = std::min(u[index(k)], 1e6) * number.sd;
    double const spread = stands_at_bound(number, value) ? number.sd : std::hypot(number.sd, own);
    all.push_back({number.name, number.mean, number.sd, value, own, (value - number.mean) / spread});
  }
  return all;
}

CandidateFinding finding_of(Candidate const& candidate) {
  return {.name = candidate.name,
          .stage = candidate.stage,
          .kind = candidate.kind,
          .chi2_after = std::numeric_limits<double>::quiet_NaN()};
}

/// Everything about the candidates: from their signatures at the calibrated fit, from the refits where there were any.
std::vector<CandidateFinding> findings(Workbench const& bench, Signatures const& first, CandidateScores const& scores,
                                       Selection const& selection) {
  std::vector<CandidateFinding> all;
  for (std::size_t k = 0; k < bench.candidates.size(); ++k) {
    Candidate const& candidate = bench.candidates[k];
    CandidateFinding found = finding_of(candidate);
    found.not_testable = first.not_testable[k];
    double const reach = scores.reach[index(k)];
    if (found.not_testable.empty() && reach == 0) found.not_testable = "calibration can do all that it does";
    if (reach > 0) {
      found.z = scores.direction[index(k)] * scores.z[index(k)];
      found.kept_fraction = scores.kept[index(k)];
      found.evidence = log_evidence(found.z, reach, candidate.two_sided);
      found.detectable = (scores.critical + 1.28) / reach * candidate.prior_scale;
      found.strength = found.z / reach * candidate.prior_scale;
      found.u_strength = candidate.prior_scale / reach;
    }
    for (std::size_t other = 0; other < bench.candidates.size(); ++other)
      if (other != k && scores.cosines(index(k), index(other)) > bench.thresholds.twin_cosine)
        found.twins.push_back(bench.candidates[other].name);
    all.push_back(std::move(found));
  }
  Eigen::VectorXd const u = bench.refit().uncertainty(selection.fit);
  constexpr double sure = 1.645;  // in 19 of 20 cases
  double const gap = std::hypot(bench.thresholds.rival_gap, sure * bench.luck(selection.fit));
  for (std::size_t a = 0; a < selection.fit.active.size(); ++a) {
    for (Trial const& trial : selection.trials[a]) all[trial.candidate].chi2_after = trial.fit.objective;
    std::size_t const chosen = selection.fit.active[a];
    CandidateFinding& found = all[chosen];
    Eigen::Index const column = u.size() - index(selection.fit.active.size()) + index(a);
    found.active = true;
    found.strength = selection.fit.point.strengths[index(chosen)];
    found.u_strength = u[column] * bench.candidates[chosen].prior_scale;
    Trial const& best = selection.trials[a].front();
    for (Trial const& rival : selection.trials[a]) {
      bool const active = std::ranges::find(selection.fit.active, rival.candidate) != selection.fit.active.end();
      // Between twins a prior alone would decide.
      bool const twins = scores.cosines(index(chosen), index(rival.candidate)) > bench.thresholds.twin_cosine;
      bool const close =
          rival.standing < best.standing + gap || (twins && rival.fit.objective < best.fit.objective + gap);
      if (!active && close) found.group.push_back(bench.candidates[rival.candidate].name);
    }
  }
  std::ranges::stable_sort(all, [](auto const& a, auto const& b) {
    return std::pair(!a.active, -a.evidence) < std::pair(!b.active, -b.evidence);
  });
  return all;
}

ObservationTable table_of(Workbench const& bench, Fit const& base, Fit const& calibrated, Fit const& last,
                          Signatures const& signatures) {
  Study const& study = bench.frame.study();
  auto const normalised = [&](Fit const& fit) {
    Projection const project = bench.projection(fit);
    Eigen::VectorXd const spread = project.diagonal().cwiseMax(0.05).cwiseSqrt() * std::sqrt(bench.sigma2);
    return Eigen::VectorXd(project(fit.residual).col(0).cwiseQuotient(spread));
  };
  Eigen::MatrixXd const all = covariance(study, calibrated.prediction);
  Prediction certain = calibrated.prediction;
  certain.u_sampling.setZero();
  certain.u_numerical.setZero();
  Eigen::VectorXd const data = covariance(study, certain).diagonal();
  return {.rows = {},
          .measured = measured_values(study),
          .base = at_observations(study, base.prediction.value),
          .calibrated = at_observations(study, calibrated.prediction.value),
          .final_model = at_observations(study, last.prediction.value),
          .u_data = data.cwiseSqrt(),
          .u_model = (all.diagonal() - data).cwiseMax(0).cwiseSqrt(),
          .residual_before = normalised(calibrated),
          .residual_after = normalised(last),
          .signatures = bench.projection(calibrated)(signatures.columns)};
}

}  // namespace

Diagnosis diagnose(Study const& given, Model& model, std::vector<Candidate> const& candidates,
                   Thresholds const& thresholds, std::uint64_t seed) {
  double const passes_before = model.passes();
  ModelPoint const prior{.calibration = prior_means(given),
                         .strengths = Eigen::VectorXd::Zero(index(candidates.size()))};
  Prediction const believed = model.predict(prior);
  Study const study = judged(given, believed);

  // Calibrate; relative uncertainties rest on the calibrated model.
  ResidualFrame const first_frame(study, believed);
  Refit const first(model, candidates, first_frame, 1.0);
  Fit base = first.from(prior, believed);
  if (!thresholds.projects) base.jacobian.setZero();
  Fit const rough = first.improved(base);
  ResidualFrame frame(study, rough.prediction);
  Fit calibrated = rough;
  calibrated.residual = frame.residual(rough.prediction);
  calibrated.jacobian = frame.whiten()(first_frame.whiten().inverse(rough.jacobian));
  calibrated = Refit(model, candidates, frame, 1.0).improved(calibrated);

  // What could be the matter, and how far the data scatter by themselves.
  Signatures signatures = probe_candidates(model, candidates, frame, calibrated);
  Patterns patterns = generic_patterns(study, at_observations(study, calibrated.prediction.value), frame.whiten());
  NoiseLevel const noise = find_noise_level(frame, calibrated, signatures, patterns, thresholds);

  // Which of it is the matter.
  LargestNull const null = PatternSearch(patterns, Projection(frame.size(), calibrated.jacobian), seed).null();
  Workbench const bench{model, candidates, frame, patterns, null, thresholds, noise.sigma2, seed};
  calibrated.objective = calibrated.residual.squaredNorm() / noise.sigma2;
  Adequacy const before = adequacy_of(bench, calibrated);
  CandidateScores const scores = score_candidates(bench, calibrated, signatures);
  Selection const selection = select_candidates(bench, calibrated, signatures, scores, before);

  Diagnosis diagnosis;
  diagnosis.effects = findings(bench, signatures, scores, selection);
  diagnosis.parameters = parameters_of(study, bench.refit(), selection.fit);
  diagnosis.patterns_before = before.patterns;
  diagnosis.patterns_after = selection.adequacy.patterns;
  diagnosis.outliers = noise.outliers;
  diagnosis.limits = study.limits;
  if (!selection.fit.converged) diagnosis.limits.push_back("the last refit still moved when its passes were used up");
  diagnosis.chi2_base = base.residual.squaredNorm() / noise.sigma2;
  diagnosis.chi2_before = before.chi2;
  diagnosis.chi2_after = selection.adequacy.chi2;
  diagnosis.dof = selection.adequacy.dof;
  diagnosis.sigma2 = noise.sigma2;
  diagnosis.structure_after = structure_of(bench, selection.fit);
  diagnosis.explained = explained_share(structure_of(bench, calibrated), diagnosis.structure_after);
  diagnosis.z_critical = scores.critical;
  diagnosis.pattern_critical = before.pattern_critical;
  for (Candidate const& candidate : candidates) diagnosis.candidate_names.push_back(candidate.name);
  diagnosis.cosines = scores.cosines;
  diagnosis.calibrated = calibrated.point;
  diagnosis.final_point = selection.fit.point;
  diagnosis.table = table_of(bench, base, calibrated, selection.fit, signatures);
  for (std::size_t i = 0; i < given.observations.size(); ++i)
    if (is_answered(given.observations[i], believed)) diagnosis.table.rows.push_back(i);
  if (!before.ok)
    diagnosis.smooth_explained =
        smooth_share(study, calibrated.residual, Projection(frame.size(), calibrated.jacobian), noise.sigma2);
  reach_verdict({bench, calibrated, before, noise, selection, diagnosis.parameters, diagnosis.smooth_explained},
                diagnosis);
  diagnosis.passes = model.passes() - passes_before;
  return diagnosis;
}

}  // namespace layerloop::validation
