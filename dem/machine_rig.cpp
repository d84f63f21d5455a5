#include "dem/machine_rig.hpp"

#include <algorithm>

namespace layerloop::dem {
namespace {
constexpr double height = 0.01;        // of blade, gate and the space above the bed [m]
constexpr double thrown_out = height;  // a grain up there does not come down while the layer is made [m]
constexpr double beyond = 200e-6;      // platforms reach that much farther than grains should [m]
constexpr double gate_width = 40e-6;   // [m]

RoundedBlock block(std::string name, double x0, double x1, double z0, double z1, double edge_radius) {
  double const most = 0.4999 * std::min(x1 - x0, z1 - z0);
  return {std::move(name), x0, x1, z0, z1, std::min(edge_radius, most), 0};
}

/// Below everything that grains can rest on.
double lowest(MachineSettings const& machine, TriangleSurface const& substrate) {
  double z = -machine.accumulation_depth;
  for (Vec3 const& v : substrate.vertices) z = std::min(z, v.z());
  return z - beyond;
}

/// Height on which the gate stands: 0, or the top of the grains that lie in its place.
double gate_foot(MachineSettings const& machine, PowderBed const& bed) {
  double foot = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    double const ahead = bed.x[i] - machine.accumulation_length;
    if (ahead > -bed.radius[i] && ahead < gate_width + bed.radius[i] && bed.z[i] > 0)
      foot = std::max(foot, bed.z[i] + bed.radius[i]);
  }
  return foot;
}
}  // namespace

RoundedBlock parked_blade(MachineSettings const& machine) {
  return block("the blade", -machine.blade_width, 0, machine.blade_clearance, height, machine.edge_radius);
}

double blade_stroke(MachineSettings const& machine) { return machine.deposition_end() + machine.blade_width; }

Rig machine_rig(Case const& checked, TriangleSurface const& substrate, PowderBed const& bed, Tools tools) {
  MachineSettings const& m = checked.machine;
  double const bottom = lowest(m, substrate), left = -m.blade_width - beyond, sink = blade_stroke(m) + sink_distance;
  double const edge = platform_edge_radius;
  Rig rig;
  rig.walls.substrate = substrate;
  rig.walls.blocks = {
      block("the left platform", left - beyond, 0, bottom, 0, 1e-6),
      block("the floor of the accumulation zone", -edge, m.accumulation_length + edge, bottom, -m.accumulation_depth,
            0),
      block("the platform between the zones", m.accumulation_length, m.deposition_begin(), bottom, 0, edge),
      block("the end platform", m.deposition_end(), sink, bottom, 0, edge),
      block("the rear wall", left - beyond, left, bottom, 2 * height, 0)};
  if (tools != Tools::none) {
    rig.walls.blocks.push_back(parked_blade(m));
  }
  if (tools == Tools::moving_blade) rig.walls.blocks.back().velocity = m.recoating_speed;
  if (tools == Tools::blade_and_gate) {
    rig.walls.blocks.push_back(
        block("the gate", m.accumulation_length, m.accumulation_length + gate_width, gate_foot(m, bed), height, 2e-6));
  }
  rig.width = m.width;
  rig.x_range = {left, sink + 10 * beyond};
  rig.z_range = {bottom, 2 * height};
  rig.sink_x = sink;
  rig.sink_z = thrown_out;
  return rig;
}

}  // namespace layerloop::dem
