#pragma once
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "validation/explanation.hpp"

namespace layerloop::validation {

/// A diagnosis of made-up tracks: what keyhole does to pool.depth at low speed, and noise.
inline Explanation sample_explanation() {
  Explanation e;
  e.seed = 7;
  Study& study = e.study;
  study.name = "tracks <on a plate>";
  for (std::size_t c = 0; c < 20; ++c) {
    study.conditions.push_back({.id = "c" + std::to_string(c),
                                .inputs = {{"laser.power", 100.0 + 50 * static_cast<double>(c % 4)},
                                           {"scan.scan_speed", 0.4 + 0.3 * std::floor(c / 4)}}});
    for (std::string const quantity : {"pool.depth", "pool.width", "absorptivity"}) {
      study.observables.push_back({c, quantity});
      study.observations.push_back({.id = "o" + std::to_string(study.observations.size()),
                                    .condition = c,
                                    .observable = study.observables.size() - 1,
                                    .quantity = quantity});
    }
  }
  study.calibration = {{.name = "laser.absorptivity", .key = "laser.absorptivity", .mean = 0.35, .sd = 0.07}};
  study.limits = {"no replicates: the noise cannot be checked"};
  for (std::string const name : {"keyhole", "marangoni", "offset of pool.depth", "plume_attenuation"})
    e.candidates.push_back({.name = name, .stage = EffectStage::heat, .prior_scale = 0.5});

  Diagnosis& d = e.found;
  auto const n = static_cast<Eigen::Index>(study.observations.size());
  auto const normal = [](std::uint64_t id) {
    auto const u = uniform4(3, RandomStream::plate_heights, id);
    return std::sqrt(-2 * std::log(u[0])) * std::cos(2 * std::numbers::pi * u[1]);
  };
  ObservationTable& t = d.table;
  for (Eigen::VectorXd* v : {&t.measured, &t.base, &t.calibrated, &t.final_model, &t.u_data, &t.u_model,
                             &t.residual_before, &t.residual_after})
    v->setZero(n);
  t.signatures.setZero(n, 4);
  for (Eigen::Index i = 0; i < n; ++i) {
    Observation const& seen = study.observations[static_cast<std::size_t>(i)];
    auto const& inputs = study.conditions[seen.condition].inputs;
    double const power = inputs.at("laser.power"), speed = inputs.at("scan.scan_speed");
    bool const length = seen.quantity != "absorptivity";
    double const scale = length ? 1e-4 * std::sqrt(power / 200 / speed) : 0.4;
    double const effect = seen.quantity == "pool.width" ? 0 : 0.3 * power / 250 / speed;
    t.u_data[i] = 0.05 * scale;
    t.u_model[i] = 0.02 * scale;
    t.base[i] = 0.9 * scale;
    t.calibrated[i] = scale;
    t.final_model[i] = scale * (1 + effect);
    t.measured[i] = t.final_model[i] + t.u_data[i] * normal(static_cast<std::uint64_t>(i));
    t.residual_after[i] = (t.measured[i] - t.final_model[i]) / t.u_data[i];
    t.residual_before[i] = (t.measured[i] - t.calibrated[i]) / t.u_data[i];
    t.signatures(i, 0) = 0.5 * effect / 0.05 / 0.31;
    t.signatures(i, 1) = seen.quantity == "pool.width" ? 2 * speed : -power / 200;
    t.signatures(i, 2) = seen.quantity == "pool.depth" ? 2 : 0;
    t.signatures(i, 3) = -0.6 * t.signatures(i, 0) + 0.1 * speed;
  }
  d.verdict = Verdict::GROUP;
  d.sentence = "keyhole or plume_attenuation is missing, and these data cannot tell which";
  d.effects = {{.name = "keyhole",
                .strength = 0.31,
                .u_strength = 0.03,
                .z = 11.2,
                .evidence = 58.1,
                .kept_fraction = 0.62,
                .detectable = 0.1,
                .chi2_after = t.residual_after.squaredNorm(),
                .active = true,
                .group = {"plume_attenuation"},
                .twins = {"plume_attenuation"}},
               {.name = "plume_attenuation",
                .strength = -0.8,
                .u_strength = 0.1,
                .z = -10.1,
                .evidence = 48,
                .kept_fraction = 0.5,
                .detectable = 0.2,
                .chi2_after = 80},
               {.name = "offset of pool.depth",
                .kind = EffectClass::instrument,
                .strength = 1.2,
                .u_strength = 0.6,
                .z = 2,
                .evidence = 0.4,
                .kept_fraction = 0.9,
                .detectable = 2.5,
                .chi2_after = std::nan("")},
               {.name = "marangoni",
                .strength = 0.1,
                .u_strength = 0.3,
                .z = 0.3,
                .evidence = -1.4,
                .kept_fraction = 0.3,
                .detectable = 1.6,
                .chi2_after = std::nan("")},
               {.name = "cohesion", .not_testable = "no quantity of this study sees a bed"}};
  d.patterns_before = {{"pool.depth falls with scan.scan_speed", -9.1, 0.0002},
                       {"absorptivity falls with scan.scan_speed", -7.0, 0.001}};
  d.patterns_after = {{"pool.width rises with laser.power", 1.9, 0.8}};
  d.parameters = {{"laser.absorptivity", 0.35, 0.07, 0.38, 0.02, 0.41}};
  d.outliers = {{"o17", 4.4}};
  d.limits = {"one spot diameter only: nothing that depends on it can be told"};
  d.chi2_before = t.residual_before.squaredNorm();
  d.chi2_base = 1.4 * d.chi2_before;
  d.chi2_after = t.residual_after.squaredNorm();
  d.dof = static_cast<double>(n) - 1;
  d.explained = 0.97;
  d.smooth_explained = 0.71;
  d.z_critical = 3.4;
  d.pattern_critical = 3.9;
  d.candidate_names = {"keyhole", "marangoni", "offset of pool.depth", "plume_attenuation"};
  d.cosines = Eigen::MatrixXd::Identity(4, 4);
  d.cosines(0, 3) = d.cosines(3, 0) = -0.97;
  d.cosines(0, 2) = d.cosines(2, 0) = 0.55;
  d.calibrated = {Eigen::VectorXd::Constant(1, 0.41), Eigen::VectorXd::Zero(4), 0};
  d.final_point = {Eigen::VectorXd::Constant(1, 0.38), Eigen::Vector4d(0.31, 0, 0, 0), 0};
  d.passes = 41.5;
  e.next = {{.condition = {.id = "n1", .inputs = {{"laser.power", 250}, {"scan.scan_speed", 0.4}}},
             .quantity = "absorptivity",
             .replicates = 3,
             .separation = 4.1,
             .difference = 0.09,
             .u = 0.044,
             .separates = {"keyhole", "plume_attenuation"},
             .simulated = true}};
  e.sha256 = {{"measurements.csv", std::string(64, 'a')}};
  e.wall_time = 12;
  return e;
}

}  // namespace layerloop::validation
