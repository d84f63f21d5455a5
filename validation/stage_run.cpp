#include "validation/stage_run.hpp"

#include "core/error.hpp"
#include "coupling/calibration.hpp"
#include "coupling/layer_loop.hpp"
#include "coupling/melt_bed.hpp"
#include "coupling/verb.hpp"

namespace layerloop::validation {
namespace {

using Places = std::set<std::pair<std::string, Spot>>;

/// Reads every quantity that `read` gives for a record.
template <class Record, class Read>
void read_all(Record const& record, Read const& read, Places const& places, RunReadings& into) {
  for (Quantity const& quantity : quantities()) {
    if (read(quantity, record, Spot{})) into.readings[quantity.name] = *read(quantity, record, Spot{});
  }
  for (auto const& [name, spot] : places) {
    if (auto const reading = read(*find_quantity(name), record, spot))
      into.readings[reading_name(name, spot)] = *reading;
  }
}

std::optional<Reading> of_layers(Quantity const& q, coupling::RunRecord const& record, Spot const& spot) {
  return q.of_layers ? std::optional(q.of_layers(record, spot)) : std::nullopt;
}
/// Where nothing is melted, what light and heat leave is not there.
std::optional<Reading> of_spread_layers(Quantity const& q, coupling::RunRecord const& record, Spot const& spot) {
  return q.verb == Verb::spread ? of_layers(q, record, spot) : std::nullopt;
}
std::optional<Reading> of_melt(Quantity const& q, coupling::MeltStudy const& study, Spot const& spot) {
  return q.of_melt ? std::optional(q.of_melt(study, spot)) : std::nullopt;
}
std::optional<Reading> of_light(Quantity const& q, coupling::AbsorptionStudy const& study, Spot const&) {
  return q.of_light ? std::optional(q.of_light(study)) : std::nullopt;
}
std::optional<Reading> of_angles(Quantity const& q, coupling::CalibrationPoint const& point, Spot const&) {
  return q.of_angles ? std::optional(q.of_angles(point)) : std::nullopt;
}

/// Runs the verb itself. \param bed  folder of the layer, where one is spread first
void compute(Verb verb, Case const& checked, std::filesystem::path const& bed, Places const& places,
             StageCache const& cache, Communicator const& comm, RunReadings& into) {
  switch (verb) {
    case Verb::spread:
      return read_all(coupling::spread_layers(checked, bed, comm, true).record, of_spread_layers, places, into);
    case Verb::melt:
      return read_all(coupling::run_melt(checked, {.folder = {}, .bed = {}, .spread = bed, .quiet = true}, comm),
                      of_melt, places, into);
    case Verb::absorb: {
      coupling::AbsorbOptions options;
      options.spread = bed;
      options.quiet = true;
      return read_all(coupling::run_absorption(checked, options, comm), of_light, places, into);
    }
    case Verb::calibrate: {
      std::vector<coupling::ContactParameters> const sets{coupling::parameters_of(checked)};
      return read_all(coupling::run_tests(sets, checked, comm, false).front(), of_angles, places, into);
    }
    case Verb::run: {
      coupling::RunOptions options;
      options.folder = cache.private_folder();
      options.quiet = true;
      read_all(coupling::run_layer_loop(checked, options, comm), of_layers, places, into);
      if (comm.is_root()) std::filesystem::remove_all(options.folder);
    }
  }
}

/// Readings that do not depend on the seed are the same run for every seed.
Case without_idle_seed(Verb verb, Case checked) {
  if (!depends_on_seed(verb, checked)) checked.seed = 0;
  return checked;
}

}  // namespace

Verb verb_for(Observable const& observable, bool scans) {
  Quantity const& quantity = *find_quantity(observable.quantity);
  bool const first = observable.layer.value_or(1) == 1;
  if (quantity.verb == Verb::melt && !first) return Verb::run;
  if (quantity.verb == Verb::absorb && scans) return first ? Verb::melt : Verb::run;
  return quantity.verb;
}

bool depends_on_seed(Verb verb, Case const& checked) {
  return verb != Verb::melt || checked.melt.bed != MeltedBed::plate || !checked.laser.absorptivity;
}

StageRun run_stage(Verb verb, Case const& checked, Places const& places, StageCache const& cache,
                   Communicator const& comm) {
  Case const seeded = without_idle_seed(verb, checked);
  std::string measured;
  for (auto const& [quantity, spot] : places) measured += reading_name(quantity, spot) + "\n";
  std::string const key = StageCache::key(verb, seeded, measured);
  if (auto const known = cache.find(key)) return {*known, 0};
  StageRun run;
  try {
    coupling::BedCache::Bed bed{{}, false};
    if (coupling::spreads_first(verb, seeded)) bed = cache.spread(seeded);
    run.computed = (bed.computed ? 1 : 0) + (verb == Verb::spread ? 0 : 1);
    compute(verb, seeded, bed.folder, places, cache, comm, run.readings);
  } catch (PhysicsError const& guard) {
    run.readings = {{}, guard.what()};
    run.computed = 1;
  }
  cache.keep(key, run.readings);
  return run;
}

}  // namespace layerloop::validation
