#include <fmt/format.h>
#include <mpi.h>

#include <thread>

#include "apps/verbs.hpp"
#include "core/communicator.hpp"

namespace layerloop::apps {

void add_doctor(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("doctor", "what this build and this machine can do");
  verb->callback([&chosen] {
    chosen = [] {
      Communicator const comm;
      if (!comm.is_root()) return;
      char library[MPI_MAX_LIBRARY_VERSION_STRING];
      int length = 0;
      MPI_Get_library_version(library, &length);
      fmt::print("layerloop {}\n", LAYERLOOP_VERSION);
      fmt::print("compiler   {}\n", __VERSION__);
      fmt::print("MPI        {}\n", std::string(library, static_cast<std::size_t>(length)));
      fmt::print("ranks      {}\n", comm.size());
      fmt::print("cores      {}\n", std::thread::hardware_concurrency());
#if defined(__AVX512F__)
      fmt::print("vectors    AVX-512\n");
#elif defined(__AVX2__)
      fmt::print("vectors    AVX2\n");
#else
      fmt::print("vectors    baseline\n");
#endif
    };
  });
}

}  // namespace layerloop::apps
