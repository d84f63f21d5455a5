#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis.hpp"
#include "validation/model.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// One reading beside what the model says of it: E = S - D and what it may be off by,
/// u_val^2 = u_num^2 + u_input^2 + u_D^2 (ASME V&V 20-2009). SI.
struct ComparedPoint {
  std::size_t observation = 0;  ///< index
  double measured = 0, simulated = 0;
  double u_data = 0;   ///< of the reading, systematic parts included
  double u_num = 0;    ///< of the simulation: mesh, time step, grains, rays
  double u_input = 0;  ///< of the simulation, from the uncertainty of calibration numbers and inputs
  double error() const { return simulated - measured; }
  double u_val() const;
  bool inside() const;  ///< |E| <= 2 u_val
};

struct ComparedQuantity {
  std::string name;
  std::size_t points = 0, unanswered = 0;  ///< readings with and without an answer of the model
  double bias = 0, rms = 0;                ///< mean and root mean square of E [SI]
  double relative_rms = 0;                 ///< root mean square of E / D
  double inside_2u = 0;                    ///< share of the points
  double area = 0;                         ///< between the distributions of S and D [SI]
  double chi2 = 0;                         ///< of these points alone
};

/// One stage of the program, with its own measurements.
struct ComparedStage {
  EffectStage stage = EffectStage::heat;
  std::size_t points = 0;
  double chi2 = 0;                          ///< as simulated
  std::optional<double> chi2_clamped = {};  ///< with the measured upstream quantity in the place of the simulated one
  std::size_t clamped_points = 0;           ///< that both are taken over
  double chi2_of_clamped_points = 0;        ///< as simulated, with the uncertainties of the clamped ones
  std::string clamped = {};                 ///< which quantity
  std::string sentence = {};
};

struct ComparedCategory {
  std::string id, condition, measured, simulated;
};

/// A model beside a study, nothing fitted.
struct Comparison {
  Study study;
  std::vector<ComparedPoint> points;  ///< in the order of acquisition
  Eigen::VectorXd standardised;       ///< by point: whitened, measured minus simulated
  std::vector<ComparedQuantity> quantities;
  std::vector<ComparedStage> stages;
  std::vector<ComparedCategory> categories;
  std::vector<PatternFinding> patterns;
  double chi2 = 0;  ///< with every uncertainty and its correlation
  std::size_t dof = 0;
  double passes = 0;
  std::uint64_t seed = 0;               ///< of the test for patterns
  std::vector<std::string> notes = {};  ///< of the model
};

/// Makes the model of a study.
using ModelMaker = std::function<std::unique_ptr<Model>(Study const&)>;

/// Runs the model as it stands, once for every calibration number beside it, and once more with the measured
/// absorptivity in the place of the simulated one, where pools were measured too.
Comparison compare(Study const& study, ModelMaker const& make, std::uint64_t seed);

}  // namespace layerloop::validation
