#include "validation/stage_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/case_file.hpp"
#include "core/error.hpp"
#include "core/json_number.hpp"
#include "core/write_file.hpp"
#include "coupling/melt_bed.hpp"

namespace layerloop::validation {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string const& name_of(Verb verb) {
  static std::array<std::string, 5> const names{"spread", "calibrate", "absorb", "melt", "run"};
  return names.at(static_cast<std::size_t>(verb));
}

std::string hash_of(std::string const& text) {
  XXH128_hash_t const hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

/// The case and the files that it names, as one text. Its name and where its files lie do not matter.
std::string content_of(Case checked) {
  std::string files;
  checked.name.clear();
  for (std::string* file :
       {&checked.machine.substrate, &checked.powder.bed, &checked.laser.profile_file, &checked.scan.path}) {
    if (!file->empty()) files += hash_of(read_file(*file)) + "\n";
    file->clear();
  }
  return fmt::format("layerloop {}\n{}{}", LAYERLOOP_VERSION, files, resolved_toml(checked));
}

void make_folder(fs::path const& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw FileError(fmt::format("cannot make the folder {} ({})", folder.string(), failure.message()));
}

/// Names that no other process writes to at this time.
fs::path own_name(fs::path const& path) { return fmt::format("{}.{}", path.string(), ::getpid()); }

double number(json const& value) { return value.is_null() ? std::nan("") : value.get<double>(); }

}  // namespace

std::string reading_name(std::string const& quantity, Spot const& spot) {
  std::string name = quantity;
  if (spot.layer) name += fmt::format(" layer {}", *spot.layer);
  if (spot.x) name += fmt::format(" x {}", *spot.x);
  if (spot.y) name += fmt::format(" y {}", *spot.y);
  return name;
}

StageCache::StageCache(fs::path folder, Communicator const& comm) : folder_(std::move(folder)), comm_(comm) {
  if (comm_.is_root())
    for (char const* part : {"beds", "runs"}) make_folder(folder_ / part);
  comm_.barrier();
}

std::string StageCache::key(Verb verb, Case const& checked, std::string const& measured) {
  return hash_of(name_of(verb) + "\n" + measured + content_of(checked));
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
    run.readings[name] = {number(one.at("value")), number(one.at("u_numerical")), number(one.at("u_sampling"))};
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

StageCache::Bed StageCache::spread(Case const& checked) const {
  Case const read = coupling::what_spreading_reads(checked);
  fs::path const folder = folder_ / "beds" / hash_of(content_of(read));
  if (!comm_.any(!fs::is_directory(folder))) return {folder, false};
  fs::path const own = own_name(folder);
  coupling::spread_layers(read, own, comm_, true);
  comm_.barrier();
  std::error_code exists;
  if (comm_.is_root()) {
    fs::rename(own, folder, exists);
    if (exists) fs::remove_all(own);  // another process was faster
  }
  comm_.barrier();
  return {folder, true};
}

fs::path StageCache::private_folder() const { return own_name(folder_ / "run"); }

}  // namespace layerloop::validation
