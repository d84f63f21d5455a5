#pragma once
#include <set>
#include <vector>

#include "validation/blind/chain_formulas.hpp"
#include "validation/candidate.hpp"
#include "validation/model.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// The whole chain in closed form: packing -> absorptivity -> melt pool, with every candidate acting inside it. A pass
/// takes a fraction of a millisecond, so that thousands of diagnoses can be scored. Deterministic; `seeds` is not used.
class AnalyticChain : public Model {
 public:
  /// \throws InputError a quantity, a calibration key or a candidate that the chain does not know
  AnalyticChain(Study const& study, std::vector<Candidate> const& candidates);
  Prediction predict(ModelPoint const& point) override;
  /// Points that differ in reading errors alone count once: the chain need not run again for them.
  double passes() const override { return static_cast<double>(computed_.size()); }

 private:
  /// One number of a ModelPoint and the input that it sets, or scales by 1 + value.
  struct InputChange {
    double ChainInputs::*input;
    bool relative;
    std::vector<bool> acts_on;  ///< by condition; empty: on all
  };
  /// One reading error, of one quantity.
  struct Reading {
    Eigen::Index candidate;
    std::string quantity;
    bool relative;
    double unit;
  };
  ChainInputs inputs_at(std::size_t observable, ModelPoint const& point) const;

  std::vector<std::string> quantities_;  ///< by observable
  std::vector<std::size_t> conditions_;  ///< by observable
  std::vector<ChainInputs> inputs_;      ///< by observable
  std::vector<InputChange> calibration_;
  std::vector<std::pair<Eigen::Index, InputChange>> input_errors_;  ///< of candidates
  std::vector<std::pair<Eigen::Index, ChainEffect>> effects_;       ///< of candidates
  std::vector<Reading> readings_;                                   ///< of candidates
  std::set<std::vector<double>> computed_;                          ///< calibration and strengths of what acts inside
};

/// Everything that may be wrong with the chain: effects of the catalogue, its discretisation, input and reading errors.
std::vector<Candidate> analytic_candidates();

}  // namespace layerloop::validation
