#include "coupling/sweep/sweep_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <new>
#include <numeric>
#include <thread>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "coupling/absorption_study.hpp"
#include "coupling/bed_cache.hpp"
#include "coupling/calibration_output.hpp"
#include "coupling/case_content.hpp"
#include "coupling/file_lock.hpp"
#include "coupling/layer_loop.hpp"
#include "coupling/melt_study.hpp"
#include "coupling/stopwatch.hpp"
#include "coupling/sweep/sweep_output.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;

/// The ranks in equal groups, a communicator for each.
class RankGroups {
 public:
  RankGroups(Communicator const& world, int groups) {
    MPI_Comm_split(world.handle(), world.rank() * groups / world.size(), world.rank(), &group_);
    MPI_Comm_dup(group_, &meeting_);
  }
  ~RankGroups() {
    MPI_Comm_free(&meeting_);
    MPI_Comm_free(&group_);
  }
  RankGroups(RankGroups const&) = delete;
  RankGroups& operator=(RankGroups const&) = delete;

  Communicator group() const { return Communicator(group_); }

  /// Whether all ranks of the group come here within a minute: then the case ended alike for all of them.
  bool all_meet() const {
    MPI_Request request;
    MPI_Ibarrier(meeting_, &request);
    for (int tick = 0; tick < 6000; ++tick) {
      int met = 0;
      MPI_Test(&request, &met, MPI_STATUS_IGNORE);
      if (met != 0) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

 private:
  MPI_Comm group_{}, meeting_{};
};

std::string content_key(Verb verb, Case const& checked) { return hash_of(name_of(verb) + "\n" + content_of(checked)); }

/// Runs the verb of a case, results in its own folder.
void compute(Verb verb, Case const& checked, fs::path const& folder, bool again, BedCache const& beds,
             Communicator const& comm) {
  fs::path bed;
  if (verb == Verb::run && shares_first_layer(checked)) {
    Case first = checked;
    first.run.layers = 1;
    bed = beds.spread(first, comm).folder;
  } else if (verb != Verb::spread && spreads_first(verb, checked)) {
    bed = beds.spread(checked, comm).folder;
  }
  switch (verb) {
    case Verb::spread:
    case Verb::run: {
      RunOptions options;
      options.folder = folder;
      options.resume = again;
      options.quiet = true;
      options.first_layer = bed;
      run_layer_loop(checked, options, comm);
      return;
    }
    case Verb::absorb: {
      AbsorbOptions options;
      options.folder = folder;
      options.spread = bed;
      options.quiet = true;
      run_absorption(checked, options, comm);
      return;
    }
    case Verb::melt:
      run_melt(checked, {.folder = folder, .bed = {}, .spread = bed, .quiet = true}, comm);
      return;
    case Verb::calibrate: {
      Calibration const found = calibrate(checked, comm, false);
      if (comm.is_root()) write_calibration(folder, checked, found);
    }
  }
}

[[noreturn]] void throw_stranger(fs::path const& folder, SweepCase const& one) {
  throw InputError(
      fmt::format("{} holds case {} of another sweep (its settings, files or the program's version "
                  "differ) choose another folder",
                  folder.string(), one.number));
}

/// One group at work on the cases of a sweep.
class SweepWorker {
 public:
  SweepWorker(SweepPlan const& plan, SweepOptions const& options, RankGroups const& ranks)
      : plan_(plan), options_(options), ranks_(ranks), comm_(ranks.group()), beds_(options.folder / "beds") {}

  enum class Outcome { not_mine, ended, stopped };  // not mine: it has ended before, or another process is at it

  Outcome attempt(SweepCase const& one) const {
    fs::path const folder = options_.folder / case_folder(one.number);
    std::unique_ptr<FileLock> lock;
    CaseRecord record;
    bool mine = false;
    if (comm_.is_root()) {
      lock = std::make_unique<FileLock>(lock_of(folder), FileLock::Wait::no);
      record = read_record(folder);
      mine = lock->held() && record.state != CaseState::done && record.state != CaseState::failed;
    }
    bool const stranger = record.state != CaseState::waiting && record.content != content_key(plan_.verb, one.checked);
    if (comm_.any(mine && stranger)) throw_stranger(options_.folder, one);
    if (!comm_.any(mine)) return Outcome::not_mine;
    bool const again = comm_.any(record.attempts > 0);
    if (comm_.is_root()) {
      record = {CaseState::interrupted, content_key(plan_.verb, one.checked), "it was killed", record.attempts + 1, 0};
      write_record(folder, record);
    }
    bool const stopped = run(one, folder, again, record);
    if (comm_.is_root()) write_record(folder, record);
    return comm_.any(stopped) ? Outcome::stopped : Outcome::ended;
  }

 private:
  /// Whether a signal stopped it.
  bool run(SweepCase const& one, fs::path const& folder, bool again, CaseRecord& record) const {
    auto const ends = [&](CaseState state, ExitCode code, std::string const& reason) {
      record.state = state;
      record.reason = reason;
      if (state == CaseState::done || comm_.size() == 1 || ranks_.all_meet()) return;
      if (comm_.is_root()) write_record(folder, record);
      fmt::print(stderr, "case {}: {}\n", one.number, reason);
      MPI_Abort(MPI_COMM_WORLD, static_cast<int>(code));
    };
    Stopwatch const timed(record.wall_time);
    try {
      compute(plan_.verb, one.checked, folder, again, beds_, comm_);
      ends(CaseState::done, ExitCode::done, "");
    } catch (StoppedBySignal const& stop) {
      ends(CaseState::interrupted, stop.code(), stop.what());
      return true;
    } catch (FileError const& trouble) {  // a full disk may have room at the next attempt
      ends(CaseState::interrupted, trouble.code(), trouble.what());
    } catch (std::bad_alloc const&) {
      ends(CaseState::interrupted, ExitCode::file_trouble, "out of memory");
    } catch (Error const& error) {
      ends(CaseState::failed, error.code(), error.what());
    } catch (std::exception const& error) {
      ends(CaseState::failed, ExitCode::bug, fmt::format("internal error: {}", error.what()));
    }
    return false;
  }

  SweepPlan const& plan_;
  SweepOptions const& options_;
  RankGroups const& ranks_;
  Communicator comm_;
  BedCache beds_;
};

std::string summary_line(SweepPlan const& plan, std::vector<CaseRecord> const& records) {
  auto const count = [&](CaseState state) { return std::ranges::count(records, state, &CaseRecord::state); };
  std::string line = fmt::format("{} of {} cases done, {} failed, {} interrupted, {} waiting", count(CaseState::done),
                                 plan.cases.size(), count(CaseState::failed), count(CaseState::interrupted),
                                 count(CaseState::waiting));
  if (count(CaseState::running) > 0) line += fmt::format(", {} with another process", count(CaseState::running));
  return line;
}

/// Root of the world: what the folder holds now, in tables and on a page. Of a job array that does the task that ends
/// last.
void sum_up(SweepPlan const& plan, SweepOptions const& options) {
  FileLock const alone(options.folder / "lock", FileLock::Wait::until_free);
  std::vector<CaseRecord> const records = read_records(plan, options.folder);
  for (std::size_t k = 0; k < records.size(); ++k) {
    bool const begun = records[k].state != CaseState::waiting;
    if (begun && records[k].content != content_key(plan.verb, plan.cases[k].checked))
      throw_stranger(options.folder, plan.cases[k]);
  }
  bool const open = std::ranges::any_of(records, [](CaseRecord const& record) {
    return record.state == CaseState::waiting || record.state == CaseState::running;
  });
  if (options.index && open) return;
  write_sweep(plan, records, options.folder);
  if (options.quiet) return;
  for (std::size_t k = 0; k < records.size(); ++k) {
    if (!records[k].reason.empty())
      fmt::print("case {} ({}) {}: {}\n", plan.cases[k].number, words_of(plan, plan.cases[k]),
                 name_of(records[k].state), records[k].reason);
  }
  fmt::print("{}\n{}\n", summary_line(plan, records), (options.folder / "report.html").string());
}

/// Whether a signal stopped it. \param before  what was known when the sweep started
bool run_open_cases(SweepPlan const& plan, SweepOptions const& options, std::vector<CaseRecord> const& before,
                    Communicator const& world) {
  auto const is_open = [&](std::size_t k) {
    bool const asked = !options.index || *options.index == plan.cases[k].number;
    return asked && before[k].state != CaseState::done && before[k].state != CaseState::failed;
  };
  std::vector<std::size_t> open(plan.cases.size());
  std::iota(open.begin(), open.end(), std::size_t{0});
  std::erase_if(open, [&](std::size_t k) { return !is_open(k); });
  RankGroups const ranks(world, options.groups);
  SweepWorker const worker(plan, options, ranks);
  Progress progress(fmt::format("{} cases", open.size()), static_cast<double>(open.size()),
                    world.is_root() && !options.quiet);
  for (std::size_t k = 0; k < open.size(); ++k) {
    if (ranks.group().any(stop_requested())) return true;
    if (worker.attempt(plan.cases[open[k]]) == SweepWorker::Outcome::stopped) return true;
    progress.update(static_cast<double>(k + 1));
  }
  return false;
}

/// A job array is told by the exit code what became of its case, a whole sweep that something has to be done again.
void throw_if_open(SweepPlan const& plan, SweepOptions const& options) {
  std::vector<CaseRecord> const records = read_records(plan, options.folder);
  std::int64_t open = 0;
  for (std::size_t k = 0; k < records.size(); ++k) {
    bool const asked = options.index == plan.cases[k].number;
    if (asked && records[k].state == CaseState::failed) throw PhysicsError(records[k].reason);
    bool const mine = !options.index || asked;
    open += mine && records[k].state == CaseState::interrupted ? 1 : 0;
  }
  if (open > 0)
    throw FileError(fmt::format("{} case{} interrupted (see {}) go on with --resume", open,
                                open == 1 ? " was" : "s were", (options.folder / "cases.csv").string()));
}

}  // namespace

std::string case_folder(std::int64_t number) { return fmt::format("case_{:04}", number); }

std::vector<CaseRecord> read_records(SweepPlan const& plan, fs::path const& folder) {
  std::vector<CaseRecord> records;
  for (SweepCase const& one : plan.cases) records.push_back(read_record_now(folder / case_folder(one.number)));
  return records;
}

bool shares_first_layer(Case const& checked) { return !checked.machine.frozen_zone; }

void refuse_strangers(SweepPlan const& plan, SweepOptions const& options) {
  if (options.index && (*options.index < 1 || *options.index > static_cast<std::int64_t>(plan.cases.size())))
    throw InputError(fmt::format("--index {} (the sweep has cases 1 to {})", *options.index, plan.cases.size()));
  if (options.folder.empty()) return;
  if (fs::exists(options.folder / "case_resolved.toml"))  // which no sweep writes there
    throw InputError(fmt::format("{} holds the results of another verb (which would be mixed) choose another folder",
                                 options.folder.string()));
  std::int64_t begun = 0;
  for (SweepCase const& one : plan.cases) {
    if (options.index && *options.index != one.number) continue;
    CaseRecord const record = read_record(options.folder / case_folder(one.number));
    if (record.state == CaseState::waiting) continue;
    ++begun;
    if (record.content != content_key(plan.verb, one.checked)) throw_stranger(options.folder, one);
  }
  if (begun > 0 && !options.resume)
    throw InputError(
        fmt::format("{} holds {} case{} of this sweep (which would be lost) go on with --resume or choose "
                    "another folder",
                    options.folder.string(), begun, begun == 1 ? "" : "s"));
}

void run_sweep(SweepPlan const& plan, SweepOptions const& options, Communicator const& world) {
  if (options.groups < 1 || world.size() % options.groups != 0)
    throw InputError(fmt::format("--groups {} (it must divide the {} ranks)", options.groups, world.size()));
  refuse_strangers(plan, options);
  std::vector<CaseRecord> const before = read_records(plan, options.folder);
  world.barrier();
  if (!options.only_report && world.any(run_open_cases(plan, options, before, world)))
    throw StoppedBySignal("stopped by a signal (as asked) go on with --resume");
  if (world.is_root()) sum_up(plan, options);
  world.barrier();
  throw_if_open(plan, options);
}

}  // namespace layerloop::coupling
