#include <fmt/format.h>
#include <omp.h>

#include <memory>

#include "apps/verbs.hpp"
#include "core/case_file.hpp"
#include "core/communicator.hpp"
#include "core/material_table.hpp"
#include "core/progress.hpp"
#include "coupling/cost.hpp"
#include "coupling/solid_on_plate.hpp"

namespace layerloop::apps {
void print_cost(Case const& checked, std::filesystem::path const& case_file) {
  coupling::solid_on_plate(checked);  // refuses a damaged substrate
  if (!Communicator{}.is_root()) return;
  coupling::Cost const cost = coupling::estimate_cost(checked);
  fmt::print(
      "{} is a good case for {}\n"
      "  particles   {}\n"
      "  time_steps  {} (sweeps; settling adds about half as many)\n"
      "  rays        {}\n"
      "  cells       {}\n"
      "  memory      {:.0f} MB\n"
      "  wall_time_estimate  {}\n",
      case_file.string(), checked.has_laser() ? "melting" : "spreading", cost.particles, cost.time_steps, cost.rays,
      cost.cells, cost.memory * 1e-6, as_time(cost.wall_time / omp_get_max_threads()));
}

void add_check(CLI::App& program, Action& chosen) {
  CLI::App* verb = program.add_subcommand("check", "is the case good, and what will it cost?");
  auto const from = std::make_shared<CaseOptions>();
  auto const help_case = std::make_shared<bool>(false), help_materials = std::make_shared<bool>(false);
  add_case_options(*verb, *from);
  verb->get_option("case")->required(false);
  verb->add_flag("--help-case", *help_case, "print every case key: unit, range, default and what it means");
  verb->add_flag("--help-materials", *help_materials, "print every value of the built-in metals with its source");
  verb->callback([=, &chosen] {
    if (*help_case || *help_materials) {
      chosen = [page = *help_case ? case_key_page : material_page] {
        if (Communicator{}.is_root()) fmt::print("{}", page());
      };
      return;
    }
    if (from->case_file.empty()) throw CLI::RequiredError("case");
    chosen = [=] { print_cost(read_case(*from, std::nullopt), from->case_file); };
  });
}

}  // namespace layerloop::apps
