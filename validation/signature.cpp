#include "validation/signature.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::validation {
namespace {

constexpr double least_change = 1e-3;  // of a signature, in standard uncertainties of all data together

struct Probe {
  Eigen::VectorXd column;
  bool answered = false;
};

Probe probed(Model& model, ResidualFrame const& frame, Fit const& fit, std::size_t candidate, double strength,
             double prior_scale) {
  ModelPoint beside = fit.point;
  beside.strengths[index(candidate)] += strength;
  Eigen::VectorXd const change = frame.change(model.predict(beside), fit.prediction);
  return {change * (prior_scale / strength), change.allFinite()};
}

void probe(Model& model, Candidate const& candidate, std::size_t k, ResidualFrame const& frame, Fit const& fit,
           Signatures& all) {
  Eigen::Index const column = index(k);
  double const room = candidate.largest - fit.point.strengths[column];
  auto const at = [&](double scale) {
    return probed(model, frame, fit, k, std::min(scale * candidate.prior_scale, room), candidate.prior_scale);
  };
  Probe found = at(1);
  if (!found.answered) {
    found = at(0.25);
  } else if (!(found.column.norm() > least_change)) {
    found = at(4);
  }
  if (!found.answered) {
    all.not_testable[k] = "the model has no answer with it";
  } else if (!(found.column.norm() > least_change)) {
    all.not_testable[k] = "it changes nothing under these conditions";
  } else {
    all.columns.col(column) = found.column;
  }
}

}  // namespace

Signatures probe_candidates(Model& model, std::vector<Candidate> const& candidates, ResidualFrame const& frame,
                            Fit const& fit) {
  Signatures all{.columns = Eigen::MatrixXd::Zero(frame.size(), index(candidates.size())),
                 .not_testable = std::vector<std::string>(candidates.size())};
  for (std::size_t k = 0; k < candidates.size(); ++k) probe(model, candidates[k], k, frame, fit, all);
  return all;
}

void probe_again(Model& model, std::vector<Candidate> const& candidates, ResidualFrame const& frame, Fit const& fit,
                 std::vector<std::size_t> const& which, Signatures& signatures) {
  for (std::size_t const k : which) probe(model, candidates[k], k, frame, fit, signatures);
}

}  // namespace layerloop::validation
