#include "coupling/scan_path.hpp"

#include <cmath>
#include <utility>

namespace layerloop::coupling {
namespace {
double middle_of_bed(MachineSettings const& machine) {
  return 0.5 * (machine.deposition_begin() + machine.deposition_end());
}
}  // namespace

std::vector<Track> scan_path(Case const& checked, std::int32_t layer) {
  ScanSettings const& scan = checked.scan;
  auto const count = scan.kind == ScanKind::track ? 1 : scan.tracks;
  double const middle = middle_of_bed(checked.machine);
  // The hatch is symmetric about its centre, so turning it by pi swaps both the order and the direction of its tracks.
  double const heading = std::cos(scan.rotation * (layer - 1));

  std::vector<Track> tracks;
  double time = 0;
  for (std::int64_t t = 0; t < count; ++t) {
    double const offset = (static_cast<double>(t) - 0.5 * static_cast<double>(count - 1)) * scan.hatch_spacing;
    double const y = 0.5 * checked.machine.width + heading * offset;
    Vec3 begin(middle - 0.5 * heading * scan.track_length, y, 0);
    Vec3 end(middle + 0.5 * heading * scan.track_length, y, 0);
    if (t % 2 == 1) std::swap(begin, end);
    double const end_time = time + scan.track_length / scan.scan_speed;
    tracks.push_back({begin, end, time, end_time, checked.laser.power});
    time = end_time + scan.dwell;
  }
  return tracks;
}

std::array<double, 2> heated_range(Case const& checked) {
  double const middle = middle_of_bed(checked.machine), half = 0.5 * checked.scan.track_length + checked.heat.margin;
  return {middle - half, middle + half};
}

}  // namespace layerloop::coupling
