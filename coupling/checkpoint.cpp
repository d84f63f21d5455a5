#include "coupling/checkpoint.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.hpp"
#include "core/hdf5_file.hpp"
#include "core/vtkhdf.hpp"
#include "core/write_file.hpp"

namespace layerloop::coupling {
namespace {

namespace fs = std::filesystem;

std::string digest(std::string const& bytes) {
  XXH128_hash_t const hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}\n", hash.high64, hash.low64);
}

fs::path digest_path(fs::path checkpoint) { return checkpoint.replace_extension(".xxh3"); }

std::vector<fs::path> newest_first(fs::path const& folder) {
  std::vector<fs::path> found;
  if (!fs::is_directory(folder)) return found;
  for (fs::directory_entry const& entry : fs::directory_iterator(folder)) {
    std::string const name = entry.path().filename().string();
    if (name.starts_with("checkpoint_") && name.ends_with(".h5")) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end(), std::greater<>());
  return found;
}

/// The case without the line that may change between a run and its continuation.
std::string without_layer_count(std::string const& case_text) {
  std::istringstream lines(case_text);
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("layers =")) kept += line + '\n';
  }
  return kept;
}

void write_text(Hdf5Writer& file, std::string_view dataset, std::string const& text) {
  auto const* bytes = reinterpret_cast<std::uint8_t const*>(text.data());
  file.write(dataset, std::span<std::uint8_t const>(bytes, text.size()), {text.size()});
}

std::string read_text(Hdf5Reader const& file, std::string_view dataset) {
  std::vector<std::uint8_t> const bytes = file.read_bytes(dataset);
  return {bytes.begin(), bytes.end()};
}

BuildState read_state(Hdf5Reader const& file) {
  BuildState state;
  std::vector<std::int64_t> const counters = file.read_int64("state/counters");
  state.layers_done = static_cast<std::int32_t>(counters.at(0));
  state.next_id = counters.at(1);
  for (std::size_t a = 0; a < 3; ++a) state.solid.grid.n[a] = static_cast<std::int32_t>(counters.at(2 + a));
  std::vector<double> const lengths = file.read_doubles("state/lengths");
  state.solid.grid.origin = Vec3(lengths.at(0), lengths.at(1), lengths.at(2));
  state.solid.grid.cell = lengths.at(3);
  state.solid.mass = file.read_doubles("solid/mass");
  state.bed = read_bed_group(file);
  state.substrate = read_surface_group(file);
  state.record = nlohmann::json::parse(read_text(file, "record")).get<RunRecord>();
  return state;
}

}  // namespace

void save_checkpoint(fs::path const& folder, BuildState const& state, std::string const& case_text) {
  fs::path const path = folder / fmt::format("checkpoint_{:04}.h5", state.layers_done);
  Hdf5Writer file(path);
  VoxelGrid const& grid = state.solid.grid;
  std::vector<std::int64_t> const counters{state.layers_done, state.next_id, grid.n[0], grid.n[1], grid.n[2]};
  std::vector<double> const lengths{grid.origin.x(), grid.origin.y(), grid.origin.z(), grid.cell};
  file.write("state/counters", std::span<std::int64_t const>(counters), {counters.size()});
  file.write("state/lengths", std::span<double const>(lengths), {lengths.size()}, "m");
  file.write("solid/mass", std::span<double const>(state.solid.mass), {state.solid.mass.size()}, "kg");
  write_bed_group(file, state.bed);
  write_surface_group(file, state.substrate);
  write_text(file, "record", nlohmann::json(state.record).dump());
  write_text(file, "case", case_text);
  file.commit();
  write_file(digest_path(path), digest(read_file(path)));

  std::vector<fs::path> const all = newest_first(folder);
  for (std::size_t old = 2; old < all.size(); ++old) {
    fs::remove(digest_path(all[old]));
    fs::remove(all[old]);
  }
}

std::optional<BuildState> load_newest_checkpoint(fs::path const& folder, std::string const& case_text,
                                                 std::string& skipped) {
  for (fs::path const& path : newest_first(folder)) {
    // The digest is checked before libhdf5 sees the file: it is not safe on damaged ones.
    if (!fs::exists(digest_path(path)) || read_file(digest_path(path)) != digest(read_file(path))) {
      skipped += fmt::format("{} is damaged or unfinished, using the one before; ", path.filename().string());
      continue;
    }
    Hdf5Reader const file(path);
    if (without_layer_count(read_text(file, "case")) != without_layer_count(case_text)) {
      throw InputError(
          fmt::format("{} belongs to another case (its settings differ from the case file) Resume with the case it was "
                      "started with, or choose another output folder.",
                      path.string()));
    }
    return read_state(file);
  }
  return std::nullopt;
}

}  // namespace layerloop::coupling
