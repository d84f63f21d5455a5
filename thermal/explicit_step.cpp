// The explicit step in one pass over the memory: inside metal it reads and writes enthalpy and peak, 24 bytes a cell.
#include "thermal/plane_sweep.hpp"

namespace layerloop::thermal {
namespace {

/// Forward Euler in place, then the sinks; peaks and times above the liquidus are kept.
class EulerStep {
 public:
  EulerStep(HeatSystem& system, double dt) : system_(system), dt_(dt), open_(system.sink.cells.begin()) {}

  struct Cells {
    double* __restrict h;
    float* __restrict peak;
    double dt;

    double operator()(std::int64_t c, double rate) const {
      double const now = h[c] + dt * rate;
      float const single = static_cast<float>(now);
      h[c] = now;
      peak[c] = single > peak[c] ? single : peak[c];
      return now;
    }
  };
  Cells cells() const { return {system_.enthalpy.data(), system_.peak.data(), dt_}; }
  void single(std::int64_t cell, double rate) { system_.enthalpy[cell] += dt_ * rate; }

  void begin_row(Row const& row) {
    skip_to(open_, system_.sink.cells.end(), row.begin);
    peak_before_.clear();
    for (auto open = open_; open != system_.sink.cells.end() && open->cell < row.end; ++open)
      peak_before_.push_back(system_.peak[static_cast<std::size_t>(open->cell)]);
  }
  /// A peak counts after the surface has given off its heat.
  void end_row(Row const& row, double hottest) {
    for (float const before : peak_before_) {
      auto const c = static_cast<std::size_t>(open_->cell);
      double& h = system_.enthalpy[c];
      if (h > system_.floor) drain(system_.sink, *open_, system_.table, dt_, h);
      system_.peak[c] = std::max(before, static_cast<float>(h));
      ++open_;
    }
    if (hottest >= system_.table.liquidus()) record_liquid(system_, row, dt_, newly_melted);
  }

  std::vector<std::int64_t> newly_melted;

 private:
  HeatSystem& system_;
  double dt_;
  std::vector<OpenCell>::iterator open_;
  std::vector<float> peak_before_;  ///< of a row's open cells
};

}  // namespace

void explicit_step(HeatSystem& system, std::span<CellPower const> source, double dt) {
  std::vector<CellPower> const sorted = ascending(source);
  system.awake.update(system.conduction, system.grid, system.enthalpy, system.floor, sorted, 1);
  std::vector<EulerStep> threads(sweep_threads(system), EulerStep(system, dt));
  system.heat_to_far_field += dt * sweep(system, sorted, threads);
  system.grid.exchange(system.enthalpy);
  for (EulerStep const& thread : threads) join_melted(system, thread.newly_melted);
  join_melted(system, neighbours_that_melted(system));
}

}  // namespace layerloop::thermal
