#include "validation/stage_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_number.hpp"
#include "core/write_file.hpp"
#include "coupling/case_content.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void make_folder(fs::path const& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw FileError(fmt::format("cannot make the folder {} ({})", folder.string(), failure.message()));
}

/// Names that no other process writes to at this time.
fs::path own_name(fs::path const& path) { return fmt::format("{}.{}", path.string(), ::getpid()); }

}  // namespace

std::string reading_name(std::string const& quantity, Spot const& spot) {
  std::string name = quantity;
  if (spot.layer) name += fmt::format(" layer {}", *spot.layer);
  if (spot.x) name += fmt::format(" x {}", *spot.x);
  if (spot.y) name += fmt::format(" y {}", *spot.y);
  return name;
}

StageCache::StageCache(fs::path folder, Communicator const& comm)
    : folder_(std::move(folder)), comm_(comm), beds_(folder_ / "beds") {
  if (comm_.is_root()) make_folder(folder_ / "runs");
  comm_.barrier();
}

std::string StageCache::key(Verb verb, Case const& checked, std::string const& measured) {
  return coupling::hash_of(coupling::name_of(verb) + "\n" + measured + coupling::content_of(checked));
}

std::optional<RunReadings> StageCache::find(std::string const& key) const {
  fs::path const path = folder_ / "runs" / (key + ".json");
  std::string text;
  if (comm_.is_root() && fs::is_regular_file(path)) text = read_file(path);
  comm_.broadcast(text);
  json const all = json::parse(text, nullptr, false);
  if (text.empty() || all.is_discarded()) return std::nullopt;  // damaged: computed again
  RunReadings run{{}, all.at("stopped").get<std::string>()};
  for (auto const& [name, one] : all.at("readings").items())
    run.readings[name] = {number_or_nan(one.at("value")), number_or_nan(one.at("u_numerical")),
                          number_or_nan(one.at("u_sampling"))};
  return run;
}

void StageCache::keep(std::string const& key, RunReadings const& run) const {
  if (!comm_.is_root()) return;
  json all{{"stopped", run.stopped}, {"readings", json::object()}};
  for (auto const& [name, one] : run.readings)
    all["readings"][name] = {
        {"value", number(one.value)}, {"u_numerical", number(one.u_numerical)}, {"u_sampling", number(one.u_sampling)}};
  fs::path const path = folder_ / "runs" / (key + ".json"), own = own_name(path);
  write_file(own, all.dump(1) + "\n");
  commit_file(own, path);
}

fs::path StageCache::private_folder() const { return own_name(folder_ / "run"); }

}  // namespace layerloop::validation
