#include "coupling/lit_bed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/bed_file.hpp"
#include "core/error.hpp"
#include "coupling/melt_bed.hpp"
#include "coupling/optics_of_case.hpp"
#include "dem/settled_plate.hpp"

namespace layerloop::coupling {
namespace {

double largest_radius(PowderBed const& bed) { return bed.size() == 0 ? 0.0 : std::ranges::max(bed.radius); }

/// Two triangles that reach beyond the box by `rim` [m].
void add_floor(TriangleSurface& surface, Vec3 const& lower, Vec3 const& upper, double z, double rim) {
  auto const first = static_cast<std::int32_t>(surface.vertices.size());
  double const x0 = lower.x() - rim, x1 = upper.x() + rim, y0 = lower.y() - rim, y1 = upper.y() + rim;
  for (Vec3 const& corner : {Vec3(x0, y0, z), Vec3(x1, y0, z), Vec3(x1, y1, z), Vec3(x0, y1, z)})
    surface.vertices.push_back(corner);
  surface.triangles.push_back({first, first + 1, first + 2});
  surface.triangles.push_back({first, first + 2, first + 3});
}

/// Box around the grains; along periodic axes the whole tile.
void find_box(LitBed& lit) {
  PowderBed const& bed = lit.bed;
  lit.lower = Vec3::Constant(1e300), lit.upper = -lit.lower;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    lit.lower = lit.lower.cwiseMin(bed.position(i) - Vec3::Constant(bed.radius[i]));
    lit.upper = lit.upper.cwiseMax(bed.position(i) + Vec3::Constant(bed.radius[i]));
  }
  if (bed.size() == 0) {
    for (Vec3 const& v : lit.surface.vertices) lit.lower = lit.lower.cwiseMin(v), lit.upper = lit.upper.cwiseMax(v);
  }
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    double const period = lit.period[static_cast<std::size_t>(axis)];
    if (period > 0) lit.lower[axis] = 0, lit.upper[axis] = period;
  }
}

/// Light near an open side would leave through it.
void keep_from_open_sides(LitBed& lit) {
  double const height = lit.upper.z() - lit.lower.z(), wide = std::max(height, 6 * largest_radius(lit.bed));
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    if (lit.period[static_cast<std::size_t>(axis)] > 0) continue;
    double const inset = std::min(wide, 0.25 * (lit.upper[axis] - lit.lower[axis]));
    lit.lower[axis] += inset, lit.upper[axis] -= inset;
  }
}

}  // namespace

LitBed bed_of_file(Case const& checked, BedSource const& source) {
  BedFile file = read_source(source, checked);
  LitBed lit;
  lit.origin = fmt::format("{} grains of {}", file.bed.size(), source.bed.filename().string());
  lit.period = {*file.periodic_x, *file.periodic_y};
  lit.bed = std::move(file.bed);
  if (!source.mesh.empty()) lit.surface = read_stl(source.mesh);
  find_box(lit);
  if (file.floor_z && checked.optics.floor != "none") {
    add_floor(lit.surface, lit.lower, lit.upper, *file.floor_z, 2 * largest_radius(lit.bed));
    lit.lower.z() = *file.floor_z;
  }
  keep_from_open_sides(lit);
  return lit;
}

LitBed bed_that_settles(Case const& checked, Communicator const& comm, bool show_progress) {
  LitBed lit;
  lit.bed = dem::settled_plate(checked, comm, show_progress);
  lit.period = {checked.absorb.plate_length, checked.absorb.plate_length};
  lit.origin = fmt::format("{} grains that settled on a level plate", lit.bed.size());
  find_box(lit);
  lit.lower.z() = 0;
  if (checked.optics.floor != "none") add_floor(lit.surface, lit.lower, lit.upper, 0, 2 * largest_radius(lit.bed));
  return lit;
}

LitBed bed_that_is_spread(Case const& checked, std::filesystem::path const& folder, Communicator const& comm,
                          bool quiet) {
  BuildState const build = spread_bed(checked, folder, comm, quiet);
  MachineSettings const& machine = checked.machine;
  LitBed lit;
  lit.bed = build.bed;
  double const rim = 2 * largest_radius(lit.bed), from = machine.deposition_begin(), to = machine.deposition_end();
  std::vector<char> keep;
  for (double const x : lit.bed.x) keep.push_back(x > from - rim && x < to + rim);
  lit.bed.retain(keep);
  if (checked.optics.floor != "none") lit.surface = build.substrate;
  lit.period = {0, machine.width};
  lit.origin = fmt::format("layer {} of {}, spread by the recoater", build.layers_done, checked.run.layers);
  find_box(lit);
  lit.lower.x() = from, lit.upper.x() = to;
  lit.lower.z() = -machine.layer_thickness * static_cast<double>(build.layers_done);
  keep_from_open_sides(lit);
  return lit;
}

raytrace::Beam beam_over(LitBed const& lit, Case const& checked) {
  double const power = checked.laser.power > 0 ? checked.laser.power : 1;
  Vec3 centre = 0.5 * (lit.lower + lit.upper);
  centre.z() = lit.upper.z();
  if (!checked.optics.uniform_beam) return spot_beam(checked.laser, centre, power);
  return even_beam(checked, centre, lit.upper.x() - lit.lower.x(), lit.upper.y() - lit.lower.y(), power);
}

BedMeasures measure(LitBed const& lit, raytrace::BedScene const& scene) {
  BedMeasures measured;
  double volume = 0, squares = 0, cubes = 0;
  for (std::size_t i = 0; i < lit.bed.size(); ++i) {
    Vec3 const p = lit.bed.position(i);
    if (p.x() < lit.lower.x() || p.x() > lit.upper.x() || p.y() < lit.lower.y() || p.y() > lit.upper.y()) continue;
    ++measured.grains;
    volume += lit.bed.volume(i);
    squares += std::pow(lit.bed.radius[i], 2), cubes += std::pow(lit.bed.radius[i], 3);
  }
  constexpr int lines = 100;  // looked along, in each direction
  double height = 0;
  Vec3 const size = lit.upper - lit.lower;
  for (int j = 0; j < lines; ++j) {
    for (int i = 0; i < lines; ++i) {
      Vec3 const from = lit.lower + Vec3((i + 0.5) / lines * size.x(), (j + 0.5) / lines * size.y(), 2 * size.z());
      raytrace::Hit const hit = scene.first_hit({from, -Vec3::UnitZ()});
      if (hit.target != raytrace::Target::nothing) height += std::max(hit.point.z() - lit.lower.z(), 0.0);
    }
  }
  measured.mean_height = height / (lines * lines);
  measured.solid_thickness = volume / (size.x() * size.y());
  measured.packing_density = measured.solid_thickness / measured.mean_height;
  measured.mean_diameter = squares > 0 ? 2 * cubes / squares : 0;
  return measured;
}

}  // namespace layerloop::coupling
