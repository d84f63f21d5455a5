#include "validation/selection.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "validation/largest_null.hpp"

namespace layerloop::validation {
namespace {

constexpr double least_kept = 1e-3;      // of a signature's norm: below, calibration can do all of it
constexpr double least_contender = 2.0;  // z from the signature: a refit may raise it
constexpr double far_behind = 0.5;       // of the highest z: below, no refit brings a candidate to the front
constexpr std::size_t most_twins = 3;    // that are refitted beside the contenders

bool is_active(Fit const& fit, std::size_t candidate) {
  return std::ranges::find(fit.active, candidate) != fit.active.end();
}

/// Those that are worth a refit: the highest scores, and the twins of the highest.
std::vector<std::size_t> contenders(Workbench const& bench, CandidateScores const& scores,
                                    std::vector<std::size_t> const& dropped) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < bench.candidates.size(); ++k)
    if (std::ranges::find(dropped, k) == dropped.end()) order.push_back(k);
  std::ranges::stable_sort(order, [&](auto a, auto b) { return scores.z[index(a)] > scores.z[index(b)]; });
  std::vector<std::size_t> chosen;
  std::size_t twins = 0;
  for (std::size_t const k : order) {
    double const least =
        chosen.empty() ? least_contender : std::max(least_contender, far_behind * scores.z[index(chosen.front())]);
    if (scores.z[index(k)] < least) break;
    bool const is_twin =
        !chosen.empty() && scores.cosines(index(k), index(chosen.front())) > bench.thresholds.twin_cosine;
    if (chosen.size() - twins < static_cast<std::size_t>(bench.thresholds.refitted_candidates)) {
      chosen.push_back(k);
    } else if (is_twin && twins < most_twins) {
      chosen.push_back(k);
      ++twins;
    }
  }
  return chosen;
}

/// As if the model were a line: what one looks at without a refit.
Fit on_the_line(Workbench const& bench, Fit wider) {
  Eigen::MatrixXd const normal = wider.jacobian.transpose() * wider.jacobian +
                                 1e-9 * Eigen::MatrixXd::Identity(wider.jacobian.cols(), wider.jacobian.cols());
  Eigen::VectorXd const step = normal.ldlt().solve(wider.jacobian.transpose() * wider.residual);
  wider.residual -= wider.jacobian * step;
  wider.objective = wider.residual.squaredNorm() / bench.sigma2;
  Candidate const& candidate = bench.candidates[wider.active.back()];
  double& strength = wider.point.strengths[index(wider.active.back())];
  strength = std::clamp(strength + step[step.size() - 1] * candidate.prior_scale,
                        candidate.two_sided ? -candidate.largest : 0.0, candidate.largest);
  return wider;
}

/// What a candidate reaches, with what its strength is beforehand: an error of a gauge or a setting is about its prior
/// scale (normal), anything else is known to its order of magnitude at best (Cauchy).
double standing(Workbench const& bench, Trial const& trial) {
  Candidate const& candidate = bench.candidates[trial.candidate];
  double const s = trial.fit.point.strengths[index(trial.candidate)] / candidate.prior_scale;
  return trial.fit.objective + (candidate.specified ? s * s : 2 * std::log1p(s * s));
}

void sort_by_standing(Workbench const& bench, std::vector<Trial>& trials) {
  for (Trial& trial : trials) trial.standing = standing(bench, trial);
  std::ranges::stable_sort(trials, {}, &Trial::standing);
}

std::vector<Trial> trials_of(Workbench const& bench, Fit const& fit, Signatures const& signatures,
                             std::vector<std::size_t> const& tried) {
  std::vector<Trial> trials;
  for (std::size_t const k : tried) {
    Fit wider = bench.refit().with(fit, k, signatures.columns.col(index(k)));
    trials.push_back(
        {k, bench.thresholds.refits ? bench.refit().improved(std::move(wider)) : on_the_line(bench, std::move(wider))});
  }
  sort_by_standing(bench, trials);
  return trials;
}

/// Strength over its uncertainty.
double score_of(Workbench const& bench, Fit const& fit, std::size_t active) {
  Eigen::Index const k = fit.jacobian.cols() - index(fit.active.size()) + index(active);
  double const strength =
      fit.point.strengths[index(fit.active[active])] / bench.candidates[fit.active[active]].prior_scale;
  return std::abs(strength) / bench.refit().uncertainty(fit)[k];
}

/// Active candidates that the others have made superfluous go.
void drop_superfluous(Workbench const& bench, Selection& selection, std::vector<std::size_t>& dropped) {
  for (std::size_t a = 0; a < selection.fit.active.size() && selection.fit.active.size() > 1;) {
    if (score_of(bench, selection.fit, a) >= bench.thresholds.drop_z) {
      ++a;
      continue;
    }
    Fit narrower = bench.refit().improved(bench.refit().without(selection.fit, a));
    if (!std::isfinite(narrower.objective)) {  // without it the model has no answer somewhere
      ++a;
      continue;
    }
    dropped.push_back(selection.fit.active[a]);
    selection.fit = std::move(narrower);
    selection.trials.erase(selection.trials.begin() + static_cast<std::ptrdiff_t>(a));
  }
}

/// Each choice was made with fewer candidates than are active now: its rivals are tried again beside the others.
void try_rivals_again(Workbench const& bench, Selection& selection) {
  if (selection.fit.active.size() < 2 || !bench.thresholds.refits) return;
  for (std::size_t a = 0; a < selection.fit.active.size(); ++a) {
    std::size_t const chosen = selection.fit.active[a];
    Fit const base = bench.refit().without(selection.fit, a);
    std::vector<Trial> trials{{chosen, selection.fit}};
    for (Trial const& rival : selection.trials[a]) {
      if (is_active(selection.fit, rival.candidate)) continue;
      Fit wider = bench.refit().with(base, rival.candidate, selection.signatures.columns.col(index(rival.candidate)));
      trials.push_back({rival.candidate, bench.refit().improved(std::move(wider))});
    }
    sort_by_standing(bench, trials);
    selection.trials[a] = trials;
    if (trials.front().candidate == chosen) continue;
    selection.fit = trials.front().fit;  // its strength stands last: so do its trials
    std::rotate(selection.trials.begin() + static_cast<std::ptrdiff_t>(a),
                selection.trials.begin() + static_cast<std::ptrdiff_t>(a) + 1, selection.trials.end());
  }
}

Adequacy chi2_of(Workbench const& bench, Projection const& project, Eigen::VectorXd const& left) {
  Adequacy found;
  found.chi2 = left.squaredNorm() / bench.sigma2;
  found.dof =
      static_cast<double>(bench.frame.size() - project.rank()) - static_cast<double>(bench.frame.spared().size());
  if (!std::isfinite(found.chi2))
    found.p = 0;  // the model has no answer there
  else if (found.dof > 0)
    found.p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(found.dof), found.chi2));
  return found;
}

/// Of what is left of signatures where calibration can do all that it may anywhere: at its bound it is no less able to
/// make two of them alike.
Eigen::MatrixXd cosines(Workbench const& bench, Fit const& fit, Eigen::MatrixXd unit) {
  if (bench.thresholds.projects) unit = Projection(bench.frame.size(), fit.jacobian)(unit);
  for (Eigen::Index k = 0; k < unit.cols(); ++k)
    if (double const norm = unit.col(k).norm(); norm > least_kept) unit.col(k) /= norm;
  return unit.transpose() * unit;
}

}  // namespace

double Workbench::luck(Fit const& fit) const { return 2 * std::sqrt(frame.sampling_variance(fit.prediction) / sigma2); }

Projection Workbench::projection(Fit const& fit) const {
  if (thresholds.projects) return {frame.size(), fit.jacobian(Eigen::all, movable_columns(frame.study(), fit))};
  return {frame.size(), fit.jacobian.rightCols(static_cast<Eigen::Index>(fit.active.size()))};
}

Adequacy chi2_of(Workbench const& bench, Fit const& fit) {
  Projection const project = bench.projection(fit);
  return chi2_of(bench, project, project(fit.residual));
}

Adequacy adequacy_of(Workbench const& bench, Fit const& fit) {
  Projection const project = bench.projection(fit);
  Eigen::VectorXd const left = project(fit.residual);
  Adequacy found = chi2_of(bench, project, left);
  PatternSearch const search(bench.patterns, project, bench.pattern_null);
  found.patterns = search.find(left, std::sqrt(bench.sigma2));
  found.pattern_critical = search.critical(bench.thresholds.family_error);
  double const largest = found.patterns.empty() ? 0 : std::abs(found.patterns.front().z);
  found.ok = found.p > bench.thresholds.adequate_p && largest < found.pattern_critical;
  return found;
}

Structure structure_of(Workbench const& bench, Fit const& fit) {
  Projection const project = bench.projection(fit);
  return PatternSearch(bench.patterns, project, bench.pattern_null)
      .structure(project(fit.residual), std::sqrt(bench.sigma2));
}

CandidateScores score_candidates(Workbench const& bench, Fit const& fit, Signatures const& signatures) {
  Projection const project = bench.projection(fit);
  double const sigma = std::sqrt(bench.sigma2);
  Eigen::MatrixXd unit = project(signatures.columns);
  Eigen::Index const n = unit.cols();
  CandidateScores found{.z = Eigen::VectorXd::Zero(n),
                        .direction = Eigen::VectorXd::Ones(n),
                        .reach = Eigen::VectorXd::Zero(n),
                        .kept = Eigen::VectorXd::Zero(n),
                        .cosines = Eigen::MatrixXd::Zero(n, n)};
  std::vector<bool> two_sided(bench.candidates.size());
  Eigen::VectorXd const left = project(fit.residual);
  for (Eigen::Index k = 0; k < n; ++k) {
    double const whole = signatures.columns.col(k).norm(), norm = unit.col(k).norm();
    bool const stands = whole > 0 && norm > least_kept * whole && !is_active(fit, static_cast<std::size_t>(k));
    two_sided[static_cast<std::size_t>(k)] = bench.candidates[static_cast<std::size_t>(k)].two_sided;
    unit.col(k) = stands ? Eigen::VectorXd(unit.col(k) / norm) : Eigen::VectorXd::Zero(unit.rows());
    if (whole > 0) found.kept[k] = norm * norm / (whole * whole);
    if (!stands) continue;
    found.reach[k] = norm / sigma;
    double const z = unit.col(k).dot(left) / sigma;
    if (two_sided[static_cast<std::size_t>(k)] && z < 0) found.direction[k] = -1;
    found.z[k] = found.direction[k] * z;
  }
  found.cosines = cosines(bench, fit, unit);
  found.critical = LargestNull(unit, two_sided, bench.seed + 1).critical(bench.thresholds.family_error);
  return found;
}

Selection select_candidates(Workbench const& bench, Fit calibrated, Signatures signatures, CandidateScores scores,
                            Adequacy before) {
  Selection selection{.fit = std::move(calibrated),
                      .trials = {},
                      .signatures = std::move(signatures),
                      .scores = std::move(scores),
                      .adequacy = std::move(before)};
  double const excess = selection.adequacy.chi2 - selection.adequacy.dof;
  std::vector<std::size_t> dropped;  // what the others made superfluous does not come back
  while (static_cast<int>(selection.fit.active.size()) < bench.thresholds.most_effects) {
    std::vector<std::size_t> const tried = contenders(bench, selection.scores, dropped);
    bool const any = !tried.empty() && selection.scores.z[index(tried.front())] > selection.scores.critical;
    if (tried.empty() || (!any && selection.adequacy.ok)) break;
    std::vector<Trial> trials = trials_of(bench, selection.fit, selection.signatures, tried);
    double const gain = selection.fit.objective - trials.front().fit.objective;
    if (!(gain > std::hypot(std::pow(selection.scores.critical, 2), bench.luck(selection.fit)))) break;
    if (!selection.fit.active.empty() && gain < bench.thresholds.least_share * excess &&
        !adequacy_of(bench, trials.front().fit).ok)
      break;
    if (bench.thresholds.refits) trials.front().fit = bench.refit().settled(std::move(trials.front().fit));
    trials.front().standing = standing(bench, trials.front());
    selection.fit = trials.front().fit;
    selection.trials.push_back(std::move(trials));
    drop_superfluous(bench, selection, dropped);
    selection.adequacy = adequacy_of(bench, selection.fit);
    selection.scores = score_candidates(bench, selection.fit, selection.signatures);
    if (selection.adequacy.ok && !(selection.scores.z.maxCoeff() > selection.scores.critical)) break;
    probe_again(bench.model, bench.candidates, bench.frame, selection.fit, contenders(bench, selection.scores, dropped),
                selection.signatures);
    selection.scores = score_candidates(bench, selection.fit, selection.signatures);
  }
  try_rivals_again(bench, selection);
  if (selection.fit.active.size() > 1) selection.adequacy = adequacy_of(bench, selection.fit);
  return selection;
}

}  // namespace layerloop::validation
