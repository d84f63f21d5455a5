#include <fmt/format.h>
#include <mpi.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/user_effect.hpp"
#include "thermal/petsc_session.hpp"

namespace layerloop {
namespace {

void tell(std::string const& message) { fmt::print(stderr, "{}\n", message); }

/// What every rank finds out alike is told once and ends in order; what one rank meets alone must stop the others too.
int end_with(Communicator const& comm, ExitCode code, std::string const& message) {
  bool const everywhere = code == ExitCode::bad_input || code == ExitCode::stopped_by_signal;
  if (comm.is_root() || !everywhere) tell(message);
  if (comm.size() > 1 && !everywhere) MPI_Abort(comm.handle(), static_cast<int>(code));
  return static_cast<int>(code);
}

/// Threads that wait for one another burn the processor by default, for milliseconds: on a machine with other work on
/// it most of the time goes there. Some ten microseconds bridge the gaps between parallel loops. OpenMP reads this
/// before main, so the program starts itself once more; where that fails it goes on as it is.
void wait_briefly(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  setenv("GOMP_SPINCOUNT", "1000", 1);
  execv("/proc/self/exe", argv);
}

int perform(apps::Action const& action) {
  Communicator const comm;
  try {
    action();
    return static_cast<int>(ExitCode::done);
  } catch (Error const& error) {
    return end_with(comm, error.code(), error.what());
  } catch (std::exception const& error) {
    return end_with(comm, ExitCode::bug,
                    fmt::format("internal error: {} Please report it with the case file.", error.what()));
  }
}

}  // namespace
}  // namespace layerloop

/// The program `layerloop`: one verb a file.
int main(int argc, char** argv) {
  using namespace layerloop;
  wait_briefly(argv);
  CLI::App program("Laser powder bed fusion, layer by layer: spread, trace, melt, mesh, and the next layer on it.",
                   "layerloop");
  program.require_subcommand(1);
  program.set_version_flag("--version", LAYERLOOP_VERSION);
  program.fallthrough();  // the options of the program may follow the verb
  std::vector<std::string> libraries;
  program.add_option("--plugin", libraries, "library of effects to load (core/user_effect.hpp; may be repeated)")
      ->type_name("LIB.so")
      ->expected(1);
  apps::Action action;
  apps::add_run(program, action);
  apps::add_spread(program, action);
  apps::add_absorb(program, action);
  apps::add_learn(program, action);
  apps::add_melt(program, action);
  apps::add_sweep(program, action);
  apps::add_bench(program, action);
  apps::add_check(program, action);
  apps::add_calibrate(program, action);
  apps::add_blind(program, action);
  apps::add_doctor(program, action);
  apps::add_effect(program, action);
  apps::add_compare(program, action);
  apps::add_explain(program, action);
  apps::add_add(program, action);
  apps::add_confirm(program, action);
  apps::add_next(program, action);
  try {
    program.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    return program.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }
  catch_stop_signals();
  thermal::PetscSession const session;
  return perform([&] {
    for (std::string const& library : libraries) load_plugin(library);
    action();
  });
}
