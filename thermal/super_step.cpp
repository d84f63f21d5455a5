#include <utility>

#include "thermal/plane_sweep.hpp"

namespace layerloop::thermal {
namespace {

/// What one stage is made of: y = of_last y_last + of_older y_older + of_start y_start + dt_last f(y_last) + dt_start
/// f(y_start).
struct StageWeights {
  double of_last = 0, of_older = 0, of_start = 0, dt_last = 0, dt_start = 0;
};

/// Meyer, Balsara & Aslam, J. Comput. Phys. 257 (2014) 594, eqs. 15 to 17, of stage j >= 1 of s.
StageWeights stage_weights(int j, int s, double dt) {
  auto const b = [](int i) { return i < 2 ? 1.0 / 3 : (i * i + i - 2.0) / (2.0 * i * (i + 1)); };
  double const w = 4 / (double(s) * s + s - 2);
  if (j == 1) return {0, 0, 1, 0, dt * b(1) * w};
  double const mu = (2.0 * j - 1) / j * b(j) / b(j - 1), nu = (1.0 - j) / j * b(j) / b(j - 2);
  return {mu, nu, 1 - mu - nu, dt * mu * w, -dt * (1 - b(j - 1)) * mu * w};
}

/// Writes the next stage over the one before the last.
class NextStage {
 public:
  NextStage(HeatSystem& system, StageWeights const& weights, bool first)
      : system_(system), weights_(weights), first_(first) {}

  struct Cells {
    double const *last, *start;
    double* __restrict older, * __restrict start_rate;
    StageWeights weights;
    bool first;

    double operator()(std::int64_t c, double rate) const {
      start_rate[c] = first ? rate : start_rate[c];
      double const y = weights.of_last * last[c] + weights.of_older * older[c] + weights.of_start * start[c] +
                       weights.dt_last * rate + weights.dt_start * start_rate[c];
      older[c] = y;
      return y;
    }
  };
  Cells cells() const {
    StepScratch& scratch = system_.scratch;
    return {system_.enthalpy.data(),
            scratch.start.data(),
            scratch.older.data(),
            scratch.start_rate.data(),
            weights_,
            first_};
  }
  void begin_row(Row const&) { singles_.clear(); }
  void single(std::int64_t cell, double rate) { singles_.push_back({cell, rate}); }
  void end_row(Row const&, double) {
    StepScratch& scratch = system_.scratch;
    for (auto const& [cell, rate] : singles_) {
      if (first_) scratch.start_rate[cell] += rate;
      scratch.older[cell] += (first_ ? weights_.dt_start : weights_.dt_last) * rate;
    }
  }

 private:
  HeatSystem& system_;
  StageWeights weights_;
  bool first_;
  std::vector<std::pair<std::int64_t, double>> singles_;  ///< of the row
};

/// Sinks, peaks and melting at the end of the step.
void finish(HeatSystem& system, double dt) {
  for (OpenCell& open : system.sink.cells) {
    double& h = system.enthalpy[static_cast<std::size_t>(open.cell)];
    if (h > system.floor) drain(system.sink, open, system.table, dt, h);
  }
  system.grid.exchange(system.enthalpy);
  std::vector<std::int64_t> newly_melted = neighbours_that_melted(system);
  for (Row const& row : system.awake.stepped()) {
    if (record_peak(system, row) >= system.table.liquidus()) record_liquid(system, row, dt, newly_melted);
  }
  join_melted(system, newly_melted);
}

}  // namespace

int super_step_stages(double dt, double stable) {
  int s = 3;
  while (0.25 * (s * s + s - 2) * stable < dt) s += 2;
  return s;
}

void super_step(HeatSystem& system, std::span<CellPower const> source, double dt, int stages) {
  std::vector<CellPower> const sorted = ascending(source);
  system.awake.update(system.conduction, system.grid, system.enthalpy, system.floor, sorted, stages);
  StepScratch& scratch = system.scratch;
  scratch.start = system.enthalpy;
  scratch.older = system.enthalpy;
  scratch.start_rate.resize(system.enthalpy.size());
  double to_far = 0, to_far_older = 0, far_at_start = 0;
  for (int j = 1; j <= stages; ++j) {
    StageWeights const w = stage_weights(j, stages, dt);
    std::vector<NextStage> threads(sweep_threads(system), NextStage(system, w, j == 1));
    double const far = sweep(system, sorted, threads);
    if (j == 1) far_at_start = far;
    double const next = w.of_last * to_far + w.of_older * to_far_older + w.dt_last * far + w.dt_start * far_at_start;
    to_far_older = std::exchange(to_far, next);
    std::swap(system.enthalpy, scratch.older);
    system.grid.exchange(system.enthalpy);
  }
  system.heat_to_far_field += to_far;
  finish(system, dt);
}

}  // namespace layerloop::thermal
