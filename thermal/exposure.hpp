#pragma once
#include <memory>
#include <vector>

#include "thermal/expose.hpp"
#include "thermal/heat_system.hpp"
#include "thermal/implicit_solver.hpp"
#include "thermal/pool_observer.hpp"

namespace layerloop::thermal {

/// One exposure in progress: chooses the steps, watches the temperature and keeps the heat ledger.
class Exposure {
 public:
  Exposure(HeatSystem& system, HeatCells const& cells, PoolObserver& pools, HeatSolver solver, double hottest_allowed,
           Communicator const& comm);

  /// Beam on for a while with constant powers. \note Collective
  void heat(AbsorbedPower const& power, double duration, double begin);
  /// Beam off until a time. \note Collective
  void rest(double duration, double begin);
  /// Beam off until nothing is above the solidus, or nothing gets colder any more. Returns the time that took [s].
  double freeze(double begin);

  /// Whether the state is still physical and heat balances, every so many steps. \note Collective
  void check_now_and_then();

  double mass_evaporated() const;  ///< so far, over all ranks [kg] \note Collective
  void write(HeatOutcome& outcome) const;

 private:
  double heat_evaporated() const;  ///< so far, over all ranks [J]
  double relax(double duration, double begin, bool until_frozen);
  void explicit_steps(std::vector<CellPower> const& source, double duration, double begin, std::int64_t count);
  void super_steps(std::vector<CellPower> const& source, double span, double begin);
  bool super_steps_pay(double span) const;
  std::int64_t implicit_step(std::vector<CellPower> const& source, double dt, double end);
  bool at_rest(double hottest);  ///< no heat flows between the cells any more
  double check();                ///< hottest enthalpy over the ranks; throws when the state is not physical

  HeatSystem& system_;
  HeatCells const& cells_;
  PoolObserver& pools_;
  HeatSolver solver_;
  double hottest_allowed_;  ///< [K]
  Communicator const& comm_;
  double stable_step_;  ///< explicit [s]
  std::unique_ptr<ImplicitSolver> implicit_;
  double heat_in_ = 0, moved_ = 0, stored_ = 0, out_ = 0, error_ = 0;
  std::int64_t explicit_count_ = 0, implicit_count_ = 0, checked_at_ = 0;  ///< steps; at the last check
};

}  // namespace layerloop::thermal
