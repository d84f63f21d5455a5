#include <algorithm>
#include <cmath>

#include "dem/machine_rig.hpp"
#include "dem/recoater.hpp"

namespace layerloop::dem {
namespace {
constexpr std::int64_t floor_key = 1;  // of the accumulation zone, see machine_rig

/// Smallest gap between grain j, which stays, and grain i on its way down by `lowered`.
double gap(PowderBed const& bed, double period, std::size_t i, std::size_t j, double lowered) {
  double const dx = bed.x[i] - bed.x[j], dy = std::remainder(bed.y[i] - bed.y[j], period);
  double const above = bed.z[i] - bed.z[j], dz = above - std::clamp(above, 0.0, lowered);
  return std::sqrt(dx * dx + dy * dy + dz * dz) - bed.radius[i] - bed.radius[j];
}

/// Would grain i, lowered, press more than now on a block?
bool hits_wall(PowderBed const& bed, std::vector<RoundedBlock> const& blocks, std::size_t i, double lowered) {
  return std::ranges::any_of(blocks, [&](RoundedBlock const& block) {
    double const now = nearest(block, bed.x[i], bed.z[i]).distance - bed.radius[i];
    double const then = nearest(block, bed.x[i], bed.z[i] - lowered).distance - bed.radius[i];
    return then < 0 && then < now;
  });
}

/// Rows that may meet while some are lowered, ascending by x.
std::vector<std::size_t> by_x(PowderBed const& bed) {
  std::vector<std::size_t> rows(bed.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = i;
  std::ranges::sort(rows, {}, [&](std::size_t i) { return std::pair(bed.x[i], bed.id[i]); });
  return rows;
}

/// Would grain i, lowered, press more than now on a grain of the other kind: one that stays if it moves itself?
bool hits_grain(PowderBed const& bed, std::vector<std::size_t> const& rows, std::vector<char> const& moves,
                std::size_t i, double lowered, double period, double largest) {
  double const reach = bed.radius[i] + largest;
  auto const x_of = [&](std::size_t row) { return bed.x[row]; };
  for (auto at = std::ranges::lower_bound(rows, bed.x[i] - reach, {}, x_of);
       at != rows.end() && bed.x[*at] < bed.x[i] + reach; ++at) {
    if (moves[*at] == moves[i]) continue;
    double const then = gap(bed, period, i, *at, lowered);
    if (then < 0 && then < gap(bed, period, i, *at, 0)) return true;
  }
  return false;
}

/// Springs between grains that moved and what did not. \param keeps  whether a grain that moved, or did not, keeps its
/// spring to this wall
template <class WallKeeps>
void drop_torn_springs(PowderBed& bed, std::vector<char> const& moves, WallKeeps const& keeps) {
  auto const moved = [&](std::int64_t id) {
    return moves[static_cast<std::size_t>(std::ranges::lower_bound(bed.id, id) - bed.id.begin())] != 0;
  };
  std::erase_if(bed.contacts, [&](ContactSpring const& c) {
    if (c.key_b >= 0) return moved(c.key_a) != moved(c.key_b);
    return !keeps(moved(c.key_a), wall_key_of(c.key_b));
  });
}
}  // namespace

void lower_plate(PowderBed& bed, Case const& checked) {
  MachineSettings const& machine = checked.machine;
  double const by = machine.layer_thickness;
  if (bed.size() == 0) return;
  Rig const rig = machine_rig(checked, {}, bed, Tools::none);
  std::vector<RoundedBlock> blocks = rig.walls.blocks;
  for (RoundedBlock& block : blocks) block.z0 = -1;  // pit walls reach below whatever the plate has come to
  double const largest = *std::ranges::max_element(bed.radius);
  std::vector<std::size_t> const rows = by_x(bed);

  std::vector<char> moves(bed.size());
  for (std::size_t i = 0; i < bed.size(); ++i)
    moves[i] =
        bed.x[i] > machine.deposition_begin() && bed.x[i] < machine.deposition_end() && !hits_wall(bed, blocks, i, by);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < bed.size(); ++i) {
      if (!moves[i] || !hits_grain(bed, rows, moves, i, by, machine.width, largest)) continue;
      moves[i] = 0;
      changed = true;
    }
  }
  for (std::size_t i = 0; i < bed.size(); ++i) bed.z[i] -= moves[i] ? by : 0.0;

  drop_torn_springs(bed, moves, [](bool moved, std::int64_t wall) { return !moved && wall < first_triangle_key; });
}

void raise_feed(PowderBed& bed, Case const& checked) {
  MachineSettings const& machine = checked.machine;
  double const by = machine.feed_rise();
  if (bed.size() == 0) return;
  double const largest = std::ranges::max(bed.radius);
  std::vector<std::size_t> const rows = by_x(bed);
  std::vector<char> moves(bed.size());
  for (std::size_t i = 0; i < bed.size(); ++i) moves[i] = bed.x[i] > 0 && bed.x[i] < machine.accumulation_length;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < bed.size(); ++i) {
      if (moves[i] || !hits_grain(bed, rows, moves, i, by, machine.width, largest)) continue;
      moves[i] = 1;  // seen from those that rise, a grain that stays comes down on them
      changed = true;
    }
  }
  for (std::size_t i = 0; i < bed.size(); ++i) bed.z[i] += moves[i] ? by : 0.0;
  drop_torn_springs(bed, moves, [](bool moved, std::int64_t wall) { return moved == (wall == floor_key); });
}

}  // namespace layerloop::dem
