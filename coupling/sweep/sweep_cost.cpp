#include "coupling/sweep/sweep_cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/progress.hpp"
#include "coupling/case_content.hpp"
#include "coupling/cost.hpp"
#include "coupling/melt_bed.hpp"
#include "coupling/sweep/sweep_run.hpp"

namespace layerloop::coupling {
namespace {

constexpr std::size_t most_rows = 40;

std::vector<Cost> costs_of(SweepPlan const& plan) {
  std::vector<Cost> costs;
  std::set<std::string> spread;
  for (SweepCase const& one : plan.cases) {
    Case bed = what_spreading_reads(one.checked);
    if (plan.verb == Verb::run) bed.run.layers = 1;
    bool const shared = (plan.verb == Verb::run && shares_first_layer(one.checked)) ||
                        (plan.verb != Verb::spread && spreads_first(plan.verb, one.checked));
    bool const there = shared && !spread.insert(hash_of(content_of(bed))).second;
    costs.push_back(estimate_cost(one.checked, there));
  }
  return costs;
}

}  // namespace

std::string cost_table(SweepPlan const& plan, std::filesystem::path const& folder) {
  std::vector<Cost> const costs = costs_of(plan);
  std::vector<CaseRecord> const records =
      folder.empty() ? std::vector<CaseRecord>(plan.cases.size()) : read_records(plan, folder);
  std::string text = fmt::format("{:>5} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7} {:>11}  settings\n", "case", "grains",
                                 "DEM steps", "rays", "cells", "heat steps", "MB", "time");
  double left = 0, memory = 0, spent = 0, foreseen = 0;
  std::size_t open = 0;
  for (std::size_t k = 0; k < costs.size(); ++k) {
    Cost const& c = costs[k];
    memory = std::max(memory, c.memory);
    if (records[k].state == CaseState::done) {
      spent += records[k].wall_time;
      foreseen += c.wall_time;
    } else if (records[k].state != CaseState::failed) {
      left += c.wall_time;
      ++open;
    }
    if (k < most_rows)
      text += fmt::format("{:>5} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7.0f} {:>11}  {}\n", plan.cases[k].number,
                          c.particles, c.time_steps, c.rays, c.cells, c.heat_steps, c.memory * 1e-6,
                          as_time(c.wall_time), words_of(plan, plan.cases[k]));
  }
  if (costs.size() > most_rows) text += fmt::format("      and {} more\n", costs.size() - most_rows);
  bool const judged = foreseen > 0 && spent > 0;
  if (judged) left *= spent / foreseen;
  return text + fmt::format("{} of {} cases to do: {} on one thread ({}), at most {:.0f} MB at a time\n", open,
                            costs.size(), as_time(left),
                            judged ? "by what the cases that are done took" : "within a factor of three or so",
                            memory * 1e-6);
}

}  // namespace layerloop::coupling
