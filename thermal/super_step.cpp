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
  if (j == 1) return {0, 0, 1, dt * b(1) * w, 0};
  double const mu = (2.0 * j - 1) / j * b(j) / b(j - 1), nu = (1.0 - j) / j * b(j) / b(j - 2);
  return {mu, nu, 1 - mu - nu, dt * mu * w, -dt * (1 - b(j - 1)) * mu * w};
}

/// Writes the next stage over the one before the last; the first one keeps dh/dt at the start too.
template <bool first>
class NextStage {
 public:
  NextStage(HeatSystem& system, StageWeights const& weights)
      : system_(system), weights_(weights), open_(system.sink.cells.begin()) {}

  struct Cells {
    double const *last, *start;
    double* __restrict older, * __restrict start_rate;
    StageWeights weights;

    double operator()(std::int64_t c, double rate) const {
      if (first) {
        start_rate[c] = rate;
        return older[c] = start[c] + weights.dt_last * rate;
      }
      return older[c] = weights.of_last * last[c] + weights.of_older * older[c] + weights.of_start * start[c] +
                        weights.dt_last * rate + weights.dt_start * start_rate[c];
    }
  };
  Cells cells() const {
    StepScratch& scratch = system_.scratch;
    return {system_.enthalpy.data(), scratch.start.data(), scratch.older.data(), scratch.start_rate.data(), weights_};
  }
  void begin_row(Row const& row) {
    singles_.clear();
    skip_to(open_, system_.sink.cells.end(), row.begin);
    for (; open_ != system_.sink.cells.end() && open_->cell < row.end; ++open_) {
      double const h = system_.enthalpy[static_cast<std::size_t>(open_->cell)];
      double const watts = h > system_.floor ? open_->area * system_.sink.flux(system_.table, h).losses : 0;
      system_.scratch.surface_flow[static_cast<std::size_t>(open_ - system_.sink.cells.begin())] = watts;
      single(open_->cell, -watts / open_->metal_volume);
    }
  }
  void single(std::int64_t cell, double rate) { singles_.push_back({cell, rate}); }
  void end_row(Row const&, double) {
    for (auto const& [cell, rate] : singles_) {
      if (first) system_.scratch.start_rate[cell] += rate;
      system_.scratch.older[cell] += weights_.dt_last * rate;
    }
  }

 private:
  HeatSystem& system_;
  StageWeights weights_;
  std::vector<OpenCell>::iterator open_;
  std::vector<std::pair<std::int64_t, double>> singles_;  ///< of the row
};

/// Heat that has left since the step began, as the stages have it [J].
struct HeatOut {
  double last = 0, older = 0, flow_at_start = 0;

  void next(StageWeights const& w, double flow, bool first) {
    if (first) flow_at_start = flow;
    double const now =
        w.of_last * last + w.of_older * older + w.dt_last * flow + (first ? 0 : w.dt_start * flow_at_start);
    older = last;
    last = now;
  }
};

/// Heat flow to the far field [W].
template <bool first>
double sweep_stage(HeatSystem& system, std::span<CellPower const> source, StageWeights const& weights) {
  std::vector<NextStage<first>> threads(sweep_threads(system), NextStage<first>(system, weights));
  return sweep(system, source, threads);
}

/// Peaks and melting at the end of the step.
void record(HeatSystem& system, double dt) {
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
  scratch.surface_flow.assign(system.sink.cells.size(), 0);
  HeatOut far, surface;
  for (int j = 1; j <= stages; ++j) {
    StageWeights const w = stage_weights(j, stages, dt);
    far.next(w, j == 1 ? sweep_stage<true>(system, sorted, w) : sweep_stage<false>(system, sorted, w), j == 1);
    double losses = 0;
    for (double const flow : scratch.surface_flow) losses += flow;
    surface.next(w, losses, j == 1);
    std::swap(system.enthalpy, scratch.older);
    system.grid.exchange(system.enthalpy);
  }
  system.heat_to_far_field += far.last;
  system.sink.lost += surface.last;
  record(system, dt);
}

}  // namespace layerloop::thermal
