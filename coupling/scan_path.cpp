#include "coupling/scan_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.hpp"
#include "coupling/scan_file.hpp"

namespace layerloop::coupling {
namespace {

Vec3 middle_of_bed(MachineSettings const& machine) {
  return {0.5 * (machine.deposition_begin() + machine.deposition_end()), 0.5 * machine.width, 0};
}

/// Unit vector; exact for quarter turns, which the sine of a rounded pi is not.
Vec3 heading(double angle) {
  auto const exact = [](double value) {
    return std::abs(value - std::round(value)) < 1e-12 ? std::round(value) : value;
  };
  return {exact(std::cos(angle)), exact(std::sin(angle)), 0};
}

std::vector<Track> hatch(Case const& checked, std::int32_t layer) {
  ScanSettings const& scan = checked.scan;
  auto const count = scan.kind == ScanKind::track ? 1 : scan.tracks;
  Vec3 const middle = middle_of_bed(checked.machine), along = heading(scan.angle(layer)),
             across(-along.y(), along.x(), 0);
  std::vector<Track> tracks;
  double time = 0;
  for (std::int64_t t = 0; t < count; ++t) {
    double const number =
        scan.track_index.empty() ? static_cast<double>(t) : scan.track_index[static_cast<std::size_t>(t)] - 1;
    double const offset = (number - 0.5 * static_cast<double>(count - 1)) * scan.hatch_spacing;
    Vec3 begin = middle + offset * across - 0.5 * scan.track_length * along,
         end = middle + offset * across + 0.5 * scan.track_length * along;
    if (t % 2 == 1) std::swap(begin, end);
    double const end_time = time + scan.track_length / scan.scan_speed;
    tracks.push_back({begin, end, time, end_time, checked.laser.power});
    time = end_time + scan.dwell;
  }
  return tracks;
}

/// Of a file, turned with the layer.
std::vector<Track> way_of_file(Case const& checked, std::int32_t layer) {
  std::vector<Track> tracks = read_scan_file(checked.scan.path);
  MachineSettings const& machine = checked.machine;
  Vec3 const middle = middle_of_bed(machine), along = heading(checked.scan.angle(layer)),
             across(-along.y(), along.x(), 0);
  for (Track& track : tracks) {
    for (Vec3* const p : {&track.begin, &track.end}) *p = middle + p->x() * along + p->y() * across;
  }
  PathBox const box = box_of(tracks);
  bool const on_bed = box.lower.x() >= machine.deposition_begin() && box.upper.x() <= machine.deposition_end() &&
                      box.lower.y() >= 0 && box.upper.y() <= machine.width;
  if (machine.width > 0 && !on_bed)
    throw InputError(
        fmt::format("{}: the beam leaves the bed (x {:.4g} to {:.4g} um, y {:.4g} to {:.4g} um from its middle, in "
                    "layer {}; the bed "
                    "is {:.4g} x {:.4g} um) shorten the way",
                    checked.scan.path, 1e6 * (box.lower - middle).x(), 1e6 * (box.upper - middle).x(),
                    1e6 * (box.lower - middle).y(), 1e6 * (box.upper - middle).y(), layer,
                    1e6 * machine.deposition_length, 1e6 * machine.width));
  return tracks;
}

}  // namespace

std::vector<Track> scan_path(Case const& checked, std::int32_t layer) {
  return checked.scan.kind == ScanKind::file ? way_of_file(checked, layer) : hatch(checked, layer);
}

PathBox box_of(std::vector<Track> const& tracks) {
  PathBox box{tracks.front().begin, tracks.front().begin};
  for (Track const& track : tracks) {
    for (Vec3 const& p : {track.begin, track.end}) box.lower = box.lower.cwiseMin(p), box.upper = box.upper.cwiseMax(p);
  }
  return box;
}

std::array<double, 2> heated_range(Case const& checked, std::int32_t layer) {
  PathBox const box = box_of(scan_path(checked, layer));
  return {box.lower.x() - checked.heat.margin, box.upper.x() + checked.heat.margin};
}

std::vector<std::optional<double>> return_times(std::vector<Track> const& tracks) {
  std::vector<std::optional<double>> times;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    Vec3 const middle = 0.5 * (tracks[t].begin + tracks[t].end);
    double nearest = 0;
    std::optional<double> since;
    for (std::size_t before = 0; before < t; ++before) {
      Track const& other = tracks[before];
      Vec3 const way = other.end - other.begin;
      double const share = std::clamp((middle - other.begin).dot(way) / way.squaredNorm(), 0.0, 1.0);
      double const distance = (other.begin + share * way - middle).norm();
      if (since && distance >= nearest) continue;
      nearest = distance;
      since = 0.5 * (tracks[t].begin_time + tracks[t].end_time) -
              (other.begin_time + share * (other.end_time - other.begin_time));
    }
    times.push_back(since);
  }
  return times;
}

}  // namespace layerloop::coupling
