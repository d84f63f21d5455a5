#include "thermal/exposure.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/compensated_sum.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"

namespace layerloop::thermal {
namespace {

constexpr double stability_margin = 0.95;
/// Implicit steps, in units of the stable explicit one: with the beam on, and the first after it.
constexpr double implicit_stride = 2;
/// Longest step with the beam off, as a share of the time since then (temperatures fall as a power of time).
constexpr double growth = 0.3;
/// More Newton iterations than this halve the next step: freezing fronts cross many cells in it.
constexpr std::int64_t many_iterations = 12;
/// Automatic choice: super steps where one replaces this many explicit ones for each of its stages.
constexpr double super_gain = 3;
/// The beam moves by at most this share of its width in a super step.
constexpr double super_travel = 1.0 / 8;
/// A stretch of constant powers with the beam on is this long a travel, in cells.
constexpr double stretch_travel = 2;
/// Enthalpy, as a share of the largest, up to which metal may sleep with the beam off.
constexpr double asleep_at_rest = 1e-4;
constexpr std::int64_t steps_between_checks = 100;
/// Pools freeze within a millisecond; what is molten after this time has lost touch with the plate, and waits as it is.
constexpr double longest_freezing = 2e-3;

/// Super steps that a stretch of constant powers is divided into. The beam's width is the edge of the square that the
/// power would cover evenly: 0.89 D4sigma of a Gaussian.
int super_steps_of_stretch(std::vector<double> const& watts) {
  double sum = 0, squares = 0;
  for (double const w : watts) sum += w, squares += w * w;
  double const width = sum > 0 ? sum / std::sqrt(squares) : 1;  // in cells
  return std::max(1, static_cast<int>(std::ceil(stretch_travel / (super_travel * width))));
}

}  // namespace

Exposure::Exposure(HeatSystem& system, HeatCells const& cells, PoolObserver& pools, HeatSolver solver,
                   double hottest_allowed, Communicator const& comm)
    : system_(system),
      cells_(cells),
      pools_(pools),
      solver_(solver),
      hottest_allowed_(hottest_allowed),
      comm_(comm),
      stable_step_(comm.min(stability_margin * stable_step(system.conduction, system.table))) {}

void Exposure::heat(AbsorbedPower const& power, double duration, double begin) {
  std::vector<CellPower> source;
  CompensatedSum watts, moved;
  for (std::size_t i = 0; i < power.cell.size(); ++i) {
    std::int64_t const host = cells_.host[static_cast<std::size_t>(power.cell[i])];
    watts.add(power.watts[i]);
    if (host != power.cell[i]) moved.add(power.watts[i]);
    std::int64_t const own = system_.conduction.box.own(cells_.grid.coordinates(host));
    if (own >= 0) source.push_back({own, power.watts[i]});
  }
  heat_in_ += watts.value() * duration;
  moved_ += moved.value() * duration;
  bool const implicit = solver_ == HeatSolver::implicit_steps;
  int const parts = super_steps_of_stretch(power.watts);
  if (double const span = duration / parts; implicit) {
    auto const count = static_cast<std::int64_t>(std::ceil(duration / (implicit_stride * stable_step_)));
    double const dt = duration / static_cast<double>(count);
    for (std::int64_t i = 0; i < count; ++i) implicit_step(source, dt, begin + static_cast<double>(i + 1) * dt);
  } else if (!system_.sink.evaporation && super_steps_pay(span)) {
    for (int i = 0; i < parts; ++i) super_steps(source, span, begin + i * span);
  } else {
    explicit_steps(source, duration, begin, static_cast<std::int64_t>(std::ceil(duration / stable_step_)));
  }
}

void Exposure::check_now_and_then() {
  if (explicit_count_ + 10 * implicit_count_ < checked_at_ + steps_between_checks) return;
  checked_at_ = explicit_count_ + 10 * implicit_count_;
  check();
}

void Exposure::rest(double duration, double begin) { relax(duration, begin, false); }

double Exposure::freeze(double begin) { return relax(longest_freezing, begin, true); }

double Exposure::relax(double duration, double begin, bool until_frozen) {
  double const solidus = system_.table.solidus(), floor = system_.floor;
  double elapsed = 0, hottest = check(), implicit_span = implicit_stride * stable_step_;
  while (elapsed < duration && !(until_frozen && hottest < solidus)) {
    double const left = duration - elapsed, long_span = std::min(growth * elapsed, left);
    double span = std::min(static_cast<double>(steps_between_checks) * stable_step_, left);
    system_.floor = std::min(floor, asleep_at_rest * hottest);
    if (solver_ == HeatSolver::implicit_steps) {
      span = std::min(implicit_span, left);
      std::int64_t const iterations = implicit_step({}, span, begin + elapsed + span);
      double const factor = iterations > many_iterations ? 0.5 : 1 + growth;
      implicit_span = std::max(implicit_stride * stable_step_, std::min(factor * span, growth * (elapsed + span)));
    } else if (hottest < solidus && super_steps_pay(long_span)) {
      span = long_span;
      super_steps({}, span, begin + elapsed);
    } else {
      explicit_steps({}, span, begin + elapsed, static_cast<std::int64_t>(std::ceil(span / stable_step_ - 1e-9)));
    }
    elapsed = left <= span ? duration : elapsed + span;
    double const now = check();
    if (until_frozen && now >= hottest * (1 - 1e-9) && at_rest(now)) break;
    hottest = now;
  }
  system_.floor = floor;
  system_.awake.forget();
  return elapsed;
}

bool Exposure::super_steps_pay(double span) const {
  return solver_ == HeatSolver::automatic && span > super_gain * stable_step_ * super_step_stages(span, stable_step_);
}

void Exposure::super_steps(std::vector<CellPower> const& source, double span, double begin) {
  int const stages = super_step_stages(span, stable_step_);
  super_step(system_, source, span, stages);
  pools_.observe(system_, begin + span);
  explicit_count_ += stages;
}

bool Exposure::at_rest(double hottest) {
  return comm_.max(largest_imbalance(system_)) < 1e-6 * system_.table.conductivity_integral(hottest);
}

void Exposure::explicit_steps(std::vector<CellPower> const& source, double duration, double begin, std::int64_t count) {
  double const dt = duration / static_cast<double>(count);
  for (std::int64_t i = 0; i < count; ++i) {
    explicit_step(system_, source, dt);
    pools_.observe(system_, begin + static_cast<double>(i + 1) * dt);
  }
  explicit_count_ += count;
}

std::int64_t Exposure::implicit_step(std::vector<CellPower> const& source, double dt, double end) {
  if (!implicit_) implicit_ = std::make_unique<ImplicitSolver>(system_);
  std::int64_t const iterations = implicit_->step(source, dt);
  pools_.observe(system_, end);
  ++implicit_count_;
  return iterations;
}

double Exposure::check() {
  if (comm_.any(stop_requested()))
    throw StoppedBySignal(
        "stopped by a signal while the metal was hot (this layer is lost, earlier ones are on disk) go on with "
        "--resume");
  CompensatedSum lost;
  for (OpenCell const& open : system_.sink.cells) lost.add(open.lost);
  out_ = heat_evaporated() + comm_.sum(lost.value() + system_.sink.lost + system_.heat_to_far_field);
  stored_ = comm_.sum(stored_heat(system_));
  if (!std::isfinite(stored_)) {
    throw PhysicsError("the temperature field is not finite (NaN) check the material's tables and the absorbed power");
  }
  double const hottest = comm_.max(thermal::hottest(system_)), T = system_.table.temperature(hottest);
  if (T > hottest_allowed_) {
    throw PhysicsError(
        fmt::format("the metal reaches {:.0f} K (the model ends at {:.0f} K: real metal would have boiled away) "
                    "{}lower laser.power, or "
                    "raise laser.spot_diameter or scan.scan_speed",
                    T, hottest_allowed_, system_.sink.evaporation ? "" : "enable effects.evaporation, "));
  }
  if (heat_in_ > 0) error_ = std::max(error_, std::abs(stored_ - heat_in_ + out_) / heat_in_);
  if (error_ > 1e-9) {
    throw PhysicsError(
        fmt::format("heat does not balance (relative error {:.3g}) report this as a bug with the case file", error_));
  }
  return hottest;
}

double Exposure::heat_evaporated() const {
  CompensatedSum vapour;
  for (OpenCell const& open : system_.sink.cells) vapour.add(open.evaporated);
  return comm_.sum(vapour.value());
}

double Exposure::mass_evaporated() const {
  return system_.sink.evaporation ? heat_evaporated() / system_.sink.evaporation->heat_of_vaporisation() : 0;
}

void Exposure::write(HeatOutcome& outcome) const {
  outcome.heat_in = heat_in_;
  outcome.heat_stored = stored_;
  outcome.heat_out = out_;
  outcome.heat_evaporated = heat_evaporated();
  outcome.heat_energy_relative_error = error_;
  outcome.moved_power_share = heat_in_ > 0 ? moved_ / heat_in_ : 0;
  outcome.mass_evaporated = mass_evaporated();
  outcome.explicit_steps = explicit_count_;
  outcome.implicit_steps = implicit_count_;
}

}  // namespace layerloop::thermal
