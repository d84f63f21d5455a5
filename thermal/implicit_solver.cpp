#include "thermal/implicit_solver.hpp"

#include <fmt/format.h>
#include <petscdmda.h>
#include <petscsnes.h>

#include "core/error.hpp"
#include "thermal/petsc_check.hpp"

namespace layerloop::thermal {
namespace {

PetscErrorCode evaluate_residual(SNES, Vec h, Vec f, void* solver) {
  static_cast<ImplicitSolver*>(solver)->residual(h, f);
  return 0;
}

PetscErrorCode evaluate_jacobian(SNES, Vec h, Mat, Mat matrix, void* solver) {
  static_cast<ImplicitSolver*>(solver)->jacobian(h, matrix);
  return 0;
}

/// Calls f(local index, position in the rank's part of a PETSc vector) for every own cell.
template <class F>
void for_own_cells(LocalBox const& box, F&& f) {
  std::int64_t position = 0;
  for (std::int32_t k = 0; k < box.n[2]; ++k) {
    for (std::int32_t j = 0; j < box.n[1]; ++j) {
      for (std::int64_t c = box.index(0, j, k); c < box.index(box.n[0], j, k); ++c) f(c, position++);
    }
  }
}

}  // namespace

ImplicitSolver::ImplicitSolver(HeatSystem& system) : system_(system) {
  std::size_t const n = system.enthalpy.size();
  trial_.assign(n, 0), integral_.assign(n, 0), rate_.assign(n, 0), source_rate_.assign(n, 0);
  DM const da = system.grid.petsc();
  check_petsc(DMSetMatType(da, MATAIJ));
  check_petsc(DMCreateMatrix(da, &matrix_));
  check_petsc(DMCreateGlobalVector(da, &unknown_));
  check_petsc(VecDuplicate(unknown_, &residual_));
  check_petsc(SNESCreate(PetscObjectComm(reinterpret_cast<PetscObject>(da)), &snes_));
  check_petsc(SNESSetOptionsPrefix(snes_, "heat_"));
  check_petsc(SNESSetType(snes_, SNESNEWTONLS));
  check_petsc(SNESSetFunction(snes_, residual_, evaluate_residual, this));
  check_petsc(SNESSetJacobian(snes_, matrix_, matrix_, evaluate_jacobian, this));
  KSP ksp;
  PC pc;
  check_petsc(SNESGetKSP(snes_, &ksp));
  SNESLineSearch search;
  check_petsc(SNESGetLineSearch(snes_, &search));
  check_petsc(SNESLineSearchSetTolerances(search, PETSC_DEFAULT, 1e30, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT,
                                          PETSC_DEFAULT));  // the default longest step, 1e8, is small in J/m^3
  check_petsc(KSPSetType(ksp, KSPBCGS));
  check_petsc(KSPSetTolerances(ksp, 1e-4, PETSC_DEFAULT, PETSC_DEFAULT, 500));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(PCSetType(pc, PCHYPRE));
  check_petsc(SNESSetLagPreconditioner(snes_, 4));  // setting up multigrid costs as much as solving
  check_petsc(SNESSetFromOptions(snes_));
}

ImplicitSolver::~ImplicitSolver() {
  SNESDestroy(&snes_);
  MatDestroy(&matrix_);
  VecDestroy(&unknown_);
  VecDestroy(&residual_);
}

void ImplicitSolver::load(Vec enthalpy) {
  PetscScalar const* h;
  check_petsc(VecGetArrayRead(enthalpy, &h));
  for_own_cells(system_.conduction.box, [&](std::int64_t c, std::int64_t position) { trial_[c] = h[position]; });
  check_petsc(VecRestoreArrayRead(enthalpy, &h));
  system_.grid.exchange(trial_);
  for (Row const& row : system_.conduction.rows_with_neighbours) {
    for (std::int64_t c = row.begin; c < row.end; ++c) integral_[c] = system_.table.conductivity_integral(trial_[c]);
  }
}

void ImplicitSolver::residual(Vec enthalpy, Vec result) {
  load(enthalpy);
  Conduction const& conduction = system_.conduction;
  far_ = conduction_balance(conduction, system_.table, trial_, integral_, rate_);
  for (Row const& row : conduction.rows) {
    for (std::int64_t c = row.begin; c < row.end; ++c)
      rate_[c] = conduction.per_capacity[c] * rate_[c] + source_rate_[c];
  }
  for (OpenCell const& open : system_.sink.cells) {
    rate_[open.cell] -= open.area / open.metal_volume * system_.sink.flux(system_.table, trial_[open.cell]).total();
  }
  PetscScalar* f;
  check_petsc(VecGetArray(result, &f));
  for_own_cells(conduction.box, [&](std::int64_t c, std::int64_t position) {
    f[position] = trial_[c] - system_.enthalpy[c] - dt_ * rate_[c];
  });
  check_petsc(VecRestoreArray(result, &f));
}

void ImplicitSolver::add_surface(double* diagonal) const {
  for (OpenCell const& open : system_.sink.cells) {
    double const h = trial_[open.cell];
    diagonal[open.cell] += dt_ * open.area / open.metal_volume * system_.sink.flux(system_.table, h).slope *
                           system_.table.temperature_slope(h);
  }
}

void ImplicitSolver::jacobian(Vec enthalpy, Mat matrix) {
  load(enthalpy);
  Conduction const& conduction = system_.conduction;
  EnthalpyTable const& table = system_.table;
  std::vector<double> diagonal(trial_.size(), 1);
  add_surface(diagonal.data());
  check_petsc(MatZeroEntries(matrix));
  auto const add = [&](std::int64_t row, std::int64_t column, double value) {
    auto const r = static_cast<PetscInt>(row), c = static_cast<PetscInt>(column);
    check_petsc(MatSetValuesLocal(matrix, 1, &r, 1, &c, &value, ADD_VALUES));
  };
  std::int64_t const sy = conduction.box.stride_y(), sz = conduction.box.stride_z();
  auto const slope = [&](std::int64_t c, bool vertical) {  // of the flows along a direction
    bool const liquid = conduction.liquid.acts() && integral_[c] > conduction.liquid.liquidus;
    double const factor = vertical ? conduction.liquid.vertical : conduction.liquid.lateral;
    return table.integral_slope(trial_[c]) * (liquid ? factor : 1);
  };
  for_own_cells(conduction.box, [&](std::int64_t c, std::int64_t) {
    if (conduction.per_capacity[c] == 0) return;
    double const factor = dt_ * conduction.per_capacity[c];
    std::pair<std::int64_t, float> const faces[] = {
        {c - 1, conduction.share_x[c - 1]}, {c + 1, conduction.share_x[c]},       {c - sy, conduction.share_y[c - sy]},
        {c + sy, conduction.share_y[c]},    {c - sz, conduction.share_z[c - sz]}, {c + sz, conduction.share_z[c]}};
    for (auto const& [next, share] : faces) {
      if (share == 0) continue;
      bool const vertical = std::abs(next - c) == sz;
      diagonal[c] += factor * share * slope(c, vertical);
      add(c, next, -factor * share * slope(next, vertical));
    }
  });
  for (ContactFace const& face : conduction.contacts) {
    if (face.conductivity == 0) continue;
    double const factor = dt_ * conduction.per_capacity[face.cell] * face.conductivity;
    diagonal[face.cell] += factor * table.temperature_slope(trial_[face.cell]);
    add(face.cell, face.neighbour, -factor * table.temperature_slope(trial_[face.neighbour]));
  }
  for (FarFace const& face : conduction.far) {
    diagonal[face.cell] +=
        dt_ * conduction.per_capacity[face.cell] * face.share * table.integral_slope(trial_[face.cell]);
  }
  for_own_cells(conduction.box, [&](std::int64_t c, std::int64_t) { add(c, c, diagonal[c]); });
  check_petsc(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
}

std::int64_t ImplicitSolver::step(std::span<CellPower const> source, double dt) {
  Conduction const& conduction = system_.conduction;
  dt_ = dt;
  for (CellPower const& heated : source) {
    source_rate_[heated.cell] += heated.watts / conduction.cell * conduction.per_capacity[heated.cell];
  }
  PetscScalar* h;
  check_petsc(VecGetArray(unknown_, &h));
  for_own_cells(conduction.box, [&](std::int64_t c, std::int64_t position) { h[position] = system_.enthalpy[c]; });
  check_petsc(VecRestoreArray(unknown_, &h));
  PetscReal norm;
  check_petsc(VecNorm(unknown_, NORM_2, &norm));
  double const floor = system_.table.solidus();  // a field at ambient has no norm of its own
  check_petsc(SNESSetTolerances(snes_, 1e-12 * std::max(norm, floor), 0, 0, 60, 10000));
  check_petsc(SNESSolve(snes_, nullptr, unknown_));
  SNESConvergedReason reason;
  check_petsc(SNESGetConvergedReason(snes_, &reason));
  if (reason < 0) {
    throw PhysicsError(
        fmt::format("the implicit heat step of {:.3g} s did not converge (PETSc reason {}) set heat.solver = "
                    "\"explicit\"",
                    dt, static_cast<int>(reason)));
  }
  PetscInt iterations;
  check_petsc(SNESGetIterationNumber(snes_, &iterations));
  residual(unknown_, residual_);
  for_own_cells(conduction.box, [&](std::int64_t c, std::int64_t) { system_.enthalpy[c] += dt * rate_[c]; });
  system_.heat_to_far_field += dt * far_;
  book(system_.sink, system_.table, dt, trial_);
  for (CellPower const& heated : source) source_rate_[heated.cell] = 0;
  finish_step(system_, dt);
  return iterations;
}

}  // namespace layerloop::thermal
