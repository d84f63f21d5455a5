#pragma once
#include <span>
#include <vector>

#include "thermal/heat_system.hpp"

struct _p_Vec;
struct _p_SNES;
struct _p_Mat;

namespace layerloop::thermal {

/// Backward Euler on the same cells, faces and sinks as the explicit step: PETSc's Newton with line search for the
/// enthalpy (T(h) is continuous where h(T) jumps, so melting does not stall it), BiCGStab and algebraic multigrid
/// inside.
///
/// The converged enthalpy gives the fluxes, and the fluxes give the new enthalpy: heat closes to round-off, and the
/// solver's tolerance (1e-12 of the enthalpy field's norm) is an error of the state alone.
class ImplicitSolver {
 public:
  explicit ImplicitSolver(HeatSystem& system);
  ~ImplicitSolver();
  ImplicitSolver(ImplicitSolver const&) = delete;
  ImplicitSolver& operator=(ImplicitSolver const&) = delete;

  /// Returns the Newton iterations it took.
  /// \throws PhysicsError when Newton does not converge (all ranks) \note Collective
  std::int64_t step(std::span<CellPower const> source, double dt);

  /// h - h_old - dt (conduction + source - sinks) / capacity of every own cell. For PETSc.
  void residual(_p_Vec* enthalpy, _p_Vec* residual);
  void jacobian(_p_Vec* enthalpy, _p_Mat* matrix);

 private:
  void load(_p_Vec* enthalpy);  ///< into trial_ and integral_, neighbours' layer included
  void add_surface(double* diagonal) const;

  HeatSystem& system_;
  _p_SNES* snes_ = nullptr;
  _p_Mat* matrix_ = nullptr;
  _p_Vec* unknown_ = nullptr;
  _p_Vec* residual_ = nullptr;
  double dt_ = 0, far_ = 0;
  std::vector<double> trial_, integral_, rate_;  ///< local; rate_: dh/dt [J/(m^3 s)]
  std::vector<double> source_rate_;              ///< [J/(m^3 s)]
};

}  // namespace layerloop::thermal
