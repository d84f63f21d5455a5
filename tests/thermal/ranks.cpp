// Run under mpiexec: all ranks compute the case together, then the root computes it alone, and both are compared.
#include <cmath>
#include <cstdio>

#include "plate.hpp"
#include "thermal/petsc_session.hpp"

namespace {

using namespace layerloop;
using namespace layerloop::thermal;

HeatOutcome run(HeatSolver solver, MPI_Comm comm) {
  CellContent const content = plate_with_grains({20, 14, 12}, 6);
  HeatSettings settings = closed_settings(5e-6);
  settings.margin = settings.substrate_depth = 40e-6;
  settings.solver = solver;
  Communicator const ranks(comm);
  return expose(content, beam_from_above(content, 20, 30e-6, 1.0, 30e-6, 70e-6), built_in_materials().at("IN718"),
                settings, effects_on({"latent_heat", "variable_conductivity", "evaporation", "surface_losses"}),
                SideY::periodic, ranks, Report::silent);
}

bool agree(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance * std::abs(b); }

bool same(HeatOutcome const& a, HeatOutcome const& b, HeatSolver solver) {
  bool ok = a.melt.melted == b.melt.melted && a.heat_in == b.heat_in;
  ok = ok && agree(a.heat_stored, b.heat_stored, 1e-10) && agree(a.heat_out, b.heat_out, 1e-10);
  if (solver == HeatSolver::explicit_steps) {
    return ok && a.melt.peak_temperature == b.melt.peak_temperature &&
           a.melt.time_above_liquidus == b.melt.time_above_liquidus && a.melt.pool.width == b.melt.pool.width &&
           a.melt.pool.depth == b.melt.pool.depth;
  }
  for (std::size_t c = 0; c < a.melt.melted.size(); ++c) {
    ok = ok && agree(a.melt.peak_temperature[c], b.melt.peak_temperature[c], 2e-7);  // single precision
  }
  return ok;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  bool ok = true;
  {
    PetscSession const petsc;
    Communicator const world;
    for (HeatSolver const solver : {HeatSolver::explicit_steps, HeatSolver::implicit_steps}) {
      HeatOutcome const together = run(solver, MPI_COMM_WORLD);
      bool fine = true;
      if (world.is_root()) {
        HeatOutcome const alone = run(solver, MPI_COMM_SELF);
        fine = same(together, alone, solver) && alone.melt.pool.width > 0;
        std::printf("%s on %d ranks: %s (stored %.17g, alone %.17g; out %.17g, alone %.17g)\n",
                    solver == HeatSolver::explicit_steps ? "explicit" : "implicit", world.size(),
                    fine ? "same" : "DIFFERENT", together.heat_stored, alone.heat_stored, together.heat_out,
                    alone.heat_out);
      }
      fine = !world.any(!fine);
      ok = ok && fine;
    }
  }
  MPI_Finalize();
  return ok ? 0 : 1;
}
