#include "dem/machine_rig.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::dem {
namespace {
constexpr double height = 0.01;        // of blade, gate and the space above the bed [m]
constexpr double thrown_out = height;  // a grain up there does not come down while the layer is made [m]
constexpr double beyond = 200e-6;      // platforms reach that much farther than grains should [m]
constexpr double gate_width = 40e-6;   // [m]

RoundedBlock block(std::string name, double x0, double x1, double z0, double z1, double edge_radius) {
  double const most = 0.4999 * std::min(x1 - x0, z1 - z0);
  return {std::move(name), x0, x1, z0, z1, std::min(edge_radius, most)};
}

/// Below everything that grains can rest on.
double lowest(MachineSettings const& machine, TriangleSurface const& substrate) {
  double z = -machine.accumulation_depth;
  for (Vec3 const& v : substrate.vertices) z = std::min(z, v.z());
  return z - beyond;
}

double recoater_length(MachineSettings const& machine) {
  return machine.recoater == RecoaterKind::roller ? machine.roller_diameter : machine.blade_width;
}

/// Height on which a gate between two heights of x stands: 0, or the top of the grains that lie in its place.
double gate_foot(PowderBed const& bed, double x0, double x1) {
  double foot = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (bed.x[i] + bed.radius[i] > x0 && bed.x[i] - bed.radius[i] < x1 && bed.z[i] > 0)
      foot = std::max(foot, bed.z[i] + bed.radius[i]);
  }
  return foot;
}

RoundedBlock gate(std::string name, PowderBed const& bed, double x0) {
  return block(std::move(name), x0, x0 + gate_width, gate_foot(bed, x0, x0 + gate_width), height, 2e-6);
}

WallMotion recoater_motion(Case const& checked) {
  MachineSettings const& m = checked.machine;
  WallMotion motion{.velocity = m.recoating_speed};
  if (double const strength = checked.effect_strength("blade_vibration"); strength > 0) {
    auto const& parameters = checked.effects.at("blade_vibration").parameters;
    motion.amplitude = strength * parameters.at("amplitude");
    motion.frequency = parameters.at("frequency");
  }
  double const softness = m.recoater == RecoaterKind::compliant_blade && !checked.effect_strength("blade_compliance")
                              ? 1.0
                              : checked.effect_strength("blade_compliance");
  if (softness > 0) {
    double const stiffness = m.blade_stiffness * m.width / softness, mass = m.blade_mass * m.width;
    motion.suspension = Suspension{mass, stiffness, 2 * m.blade_damping * std::sqrt(stiffness * mass)};
  }
  return motion;
}

void set_motion(Walls& walls, WallMotion const& motion) {
  if (walls.rollers.empty())
    walls.blocks.back().motion = motion;
  else
    walls.rollers.back().motion = motion;
}

std::vector<RoundedBlock> platforms(MachineSettings const& m, double left, double right, double bottom) {
  double const edge = m.platform_edge_radius;
  std::vector<RoundedBlock> blocks = {
      block("the left platform", left - beyond, 0, bottom, 0, 1e-6),
      block("the floor of the accumulation zone", -edge, m.accumulation_length + edge, bottom, -m.accumulation_depth,
            0),
      block("the platform between the zones", m.accumulation_length, m.deposition_begin(), bottom, 0, edge),
      block("the end platform", m.deposition_end(), right, bottom, m.end_wall == EndWall::high ? height : 0.0, edge),
      block("the rear wall", left - beyond, left, bottom, 2 * height, 0)};
  if (m.end_wall == EndWall::open) {  // out of reach, so that walls keep their numbers
    blocks[3].x0 += height;
    blocks[3].x1 += height;
  }
  return blocks;
}
}  // namespace

void add_parked_recoater(Walls& walls, MachineSettings const& m) {
  if (m.recoater == RecoaterKind::roller) {
    double const radius = 0.5 * m.roller_diameter, spin = -m.roller_spin * m.recoating_speed / radius;
    walls.rollers.push_back({"the roller", -radius, m.blade_clearance + radius, radius, spin});
    walls.rollers.back().friction = m.blade_friction;
    return;
  }
  walls.blocks.push_back(block("the blade", -m.blade_width, 0, m.blade_clearance, height, m.edge_radius));
  walls.blocks.back().edge_exponent = m.edge_exponent;
  walls.blocks.back().friction = m.blade_friction;
}

double blade_stroke(MachineSettings const& m) {
  if (m.end_wall == EndWall::high) return m.deposition_end() - 2 * m.layer_thickness;
  if (m.recoater != RecoaterKind::roller) return m.deposition_end() + m.blade_width;
  // the axis goes on until the gap over the last grains has doubled
  double const gap = m.layer_thickness + m.blade_clearance;
  return m.deposition_end() + 0.5 * m.roller_diameter + std::sqrt(m.roller_diameter * gap);
}

Case case_of_layer(Case const& checked, std::int64_t layer) {
  Case now = checked;
  if (checked.machine.dosing == Dosing::feed)
    now.machine.accumulation_depth -= static_cast<double>(layer - 1) * checked.machine.feed_rise();
  return now;
}

Rig machine_rig(Case const& checked, TriangleSurface const& substrate, PowderBed const& bed, Tools tools) {
  MachineSettings const& m = checked.machine;
  double const bottom = lowest(m, substrate), left = -recoater_length(m) - beyond;
  double const end = m.deposition_end() + recoater_length(m) + sink_distance;
  Rig rig;
  Walls& walls = rig.walls;
  walls.substrate = substrate;
  walls.blocks = platforms(m, left, end, bottom);
  if (tools == Tools::moving_recoater) {
    add_parked_recoater(walls, m);
    set_motion(walls, recoater_motion(checked));
  } else if (tools != Tools::none) {
    if (m.recoater == RecoaterKind::roller)
      walls.blocks.push_back(gate("the rear gate", bed, -gate_width));
    else
      add_parked_recoater(walls, m);
    if (tools == Tools::parked_and_gate) walls.blocks.push_back(gate("the gate", bed, m.accumulation_length));
  }
  rig.width = m.width;
  rig.x_range = {left, end + 10 * beyond};
  rig.z_range = {bottom, 2 * height};
  rig.sink_x = m.end_wall == EndWall::open ? m.deposition_end() : end;
  rig.sink_z = thrown_out;
  return rig;
}

}  // namespace layerloop::dem
