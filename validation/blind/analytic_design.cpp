#include "validation/blind/analytic_design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/random.hpp"

namespace layerloop::validation {
namespace {

constexpr std::size_t conditions = 50, builds = 5;

/// Draws of one design: `what` keeps its columns apart.
double uniform(std::uint64_t seed, std::uint32_t what, std::size_t i) {
  return uniform4(seed, RandomStream::blind_design, i, what)[0];
}

/// The levels in equal shares, in random order.
std::vector<double> column(std::uint64_t seed, std::uint32_t what, std::vector<double> const& levels) {
  std::vector<std::size_t> order(conditions);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::size_t i) { return uniform(seed, what, i); });
  std::vector<double> values(conditions);
  for (std::size_t i = 0; i < conditions; ++i) values[order[i]] = levels[i % levels.size()];
  return values;
}

std::vector<Condition> draw_conditions(std::uint64_t seed) {
  auto const speed = column(seed, 0, {0.4, 0.6, 0.8, 1.0, 1.2, 1.6}), spot = column(seed, 1, {60e-6, 80e-6, 100e-6}),
             layer = column(seed, 2, {0, 30e-6, 40e-6, 50e-6, 60e-6}), recoat = column(seed, 3, {0.05, 0.1, 0.2}),
             hatch = column(seed, 4, {0, 90e-6, 120e-6}), ambient = column(seed, 5, {300, 300, 473}),
             machine = column(seed, 6, {0, 1});
  std::vector<Condition> all;
  for (std::size_t i = 0; i < conditions; ++i) {
    double const power = 10 * std::round(14 + 10 * speed[i] + 17 * uniform(seed, 7, i));
    std::size_t const build = i * builds / conditions;
    Condition condition{.id = fmt::format("c{:02}", i + 1)};
    condition.inputs = {{"laser.power", power},
                        {"scan.scan_speed", speed[i]},
                        {"laser.spot_diameter", spot[i]},
                        {"heat.ambient_temperature", ambient[i]}};
    if (layer[i] > 0)
      condition.inputs.insert({{"machine.layer_thickness", layer[i]}, {"machine.recoating_speed", recoat[i]}});
    if (hatch[i] > 0) condition.inputs.insert({"scan.hatch_spacing", hatch[i]});
    condition.labels = {{"machine", machine[i] > 0 ? "B" : "A"},
                        {"build", fmt::format("b{}", build + 1)},
                        {"lot", build % 2 == 0 ? "L1" : "L2"}};
    all.push_back(condition);
  }
  return all;
}

/// How a quantity is measured. Uncertainties of the reading are relative to `typical`.
struct Instrument {
  std::string quantity, group;
  double typical, u_stat, u_sys_rel;
  bool powder_only;
  double share;    ///< of the conditions
  int replicates;  ///< at most
};

std::vector<Instrument> const& instruments() {
  static std::vector<Instrument> const all{{"pool.width", "sections", 130e-6, 0.025, 0.01, false, 1.0, 3},
                                           {"pool.depth", "sections", 70e-6, 0.035, 0.015, false, 1.0, 3},
                                           {"absorptivity", "calorimeter", 0.45, 0.025, 0.02, false, 0.8, 1},
                                           {"bed.relative_density", "tomography", 0.5, 0.015, 0.01, true, 0.8, 2},
                                           {"bed.surface_coverage", "microscope", 0.9, 0.015, 0.01, true, 0.8, 2}};
  return all;
}

struct Place {
  int layer;
  double x, y;
};

void add_rows(Study& study, std::uint64_t seed, std::size_t c, Place const& place, std::size_t instrument, Role role) {
  Instrument const& how = instruments()[instrument];
  auto const draw = uniform4(seed, RandomStream::blind_design, c, 20 + static_cast<std::uint32_t>(instrument));
  if (draw[0] > how.share) return;
  std::size_t const observable = study.observables.size();
  bool const pool = how.group == "sections";
  study.observables.push_back({c, how.quantity, place.layer, place.x, place.y});
  int const rows = draw[1] < 0.35 ? how.replicates : pool ? 1 : std::min(how.replicates, 1);
  for (int r = 0; r < rows; ++r) {
    Observation row{.id = fmt::format("m{:03}", study.observations.size() + 1),
                    .condition = c,
                    .observable = observable,
                    .quantity = how.quantity};
    row.u_stat = how.u_stat * how.typical, row.u_sys_rel = how.u_sys_rel;
    row.sys_group = how.group, row.role = role;
    row.oper = pool ? "cross-section" : "direct", row.instrument = how.group;
    if (rows > 1) row.rep_id = fmt::format("{}", r + 1);
    study.observations.push_back(row);
  }
}

std::vector<CalibrationParameter> calibration_numbers() {
  return {{"laser.absorptivity", "laser.absorptivity", 0.35, 0.04},
          {"material.conductivity", "material.conductivity", 26, 2},
          {"material.specific_heat", "material.specific_heat", 720, 40},
          {"contact.sliding_friction", "contact.sliding_friction", 0.5, 0.08},
          {"error of laser.spot_diameter", "laser.spot_diameter", 0, 0.04, true}};
}

}  // namespace

Study analytic_design(std::uint64_t seed) {
  Study study;
  study.name = fmt::format("design {}", seed);
  study.conditions = draw_conditions(seed);
  study.calibration = calibration_numbers();
  std::vector<double> const rank = column(seed, 8, {0, 1, 2, 3, 4});
  for (std::size_t c = 0; c < conditions; ++c) {
    auto const draw = uniform4(seed, RandomStream::blind_design, c, 9);
    bool const powder = study.conditions[c].inputs.contains("machine.layer_thickness");
    int const layer = !powder || draw[0] < 0.4 ? 1 : draw[0] < 0.7 ? 5 : 20;
    Place const place{layer, 1e-3 * std::round(120 * draw[1] - 60), 1e-3 * std::round(120 * draw[2] - 60)};
    Role const role = rank[c] == 0 ? Role::holdout : Role::train;
    for (std::size_t i = 0; i < instruments().size(); ++i)
      if (powder || !instruments()[i].powder_only) add_rows(study, seed, c, place, i, role);
  }
  return study;
}

Study part_of(Study const& study, Role role) {
  Study part = study;
  part.observations.clear(), part.observables.clear();
  std::map<std::size_t, std::size_t> renumbered;
  for (Observation row : study.observations) {
    if (row.role != role) continue;
    auto const [found, fresh] = renumbered.try_emplace(row.observable, part.observables.size());
    if (fresh) part.observables.push_back(study.observables[row.observable]);
    row.observable = found->second;
    part.observations.push_back(row);
  }
  return part;
}

}  // namespace layerloop::validation
