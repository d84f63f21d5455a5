#include "raytrace/bed_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "raytrace/embree_scene.hpp"
#include "raytrace/sphere_grid.hpp"

namespace layerloop::raytrace {
namespace {

constexpr int max_crossings = 10000;
/// Spheres in a cell up to which the grid is faster than Embree: bench/README.md, section rays.
constexpr double max_crowding = 100;

/// Corners of an upright box around everything.
struct Box {
  Vec3 lower = Vec3::Constant(infinity), upper = Vec3::Constant(-infinity);

  void include(Vec3 const& from, Vec3 const& to) {
    lower = lower.cwiseMin(from);
    upper = upper.cwiseMax(to);
  }
  void shift(Vec3 const& by) { lower += by, upper += by; }
};

Box box_around(PowderBed const& bed) {
  Box box;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (!(bed.position(i).allFinite() && std::isfinite(bed.radius[i]) && bed.radius[i] > 0)) {
      throw PhysicsError(
          fmt::format("grain {} cannot be traced (centre {:g}, {:g}, {:g} m, radius {:g} m): the stage that moved "
                      "it has failed; try a smaller time step",
                      bed.id[i], bed.x[i], bed.y[i], bed.z[i], bed.radius[i]));
    }
    box.include(bed.position(i) - Vec3::Constant(bed.radius[i]), bed.position(i) + Vec3::Constant(bed.radius[i]));
  }
  return box;
}

Box box_around(TriangleSurface const& surface) {
  Box box;
  for (Vec3 const& vertex : surface.vertices) {
    if (!vertex.allFinite()) throw PhysicsError("the substrate has a corner that is not a number: check its mesh");
    box.include(vertex, vertex);
  }
  return box;
}

/// By how much a grain must be moved along one axis to be seen in the tile: not at all, and by whole periods when it
/// reaches over an edge.
std::vector<double> image_offsets(double centre, double radius, double period) {
  if (!(period > 0)) return {0};
  std::vector<double> offsets;
  double const most = std::ceil(radius / period);
  for (double k = -most; k <= most; ++k) {
    double const at = centre + k * period;
    if (k == 0 || (at > -radius && at < period + radius)) offsets.push_back(k * period);
  }
  return offsets;
}

void check_in_tile(PowderBed const& bed, std::array<double, 2> const& period) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (!(std::isfinite(period[axis]) && period[axis] >= 0)) {
      throw InputError(
          fmt::format("a periodic tile of {:g} m along {} is impossible: give a length, or 0 for open sides",
                      period[axis], axis == 0 ? "x" : "y"));
    }
    for (std::size_t i = 0; i < bed.size() && period[axis] > 0; ++i) {
      double const centre = axis == 0 ? bed.x[i] : bed.y[i];
      if (centre >= 0 && centre <= period[axis]) continue;
      throw InputError(
          fmt::format("grain {} has its centre at {} = {:g} m (outside the periodic tile [0, {:g}) m): wrap it "
                      "into the tile before tracing",
                      bed.id[i], axis == 0 ? "x" : "y", centre, period[axis]));
    }
  }
}

}  // namespace

struct BedScene::Data {
  std::vector<Sphere> spheres;      // grains and their copies across periodic edges, about the middle
  std::vector<std::int32_t> owner;  // row of the grain in the bed
  std::vector<double> grain_radius;
  std::vector<std::int32_t> grain_material;
  TriangleSurface substrate;
  std::array<double, 2> period{};
  Box box;         // of everything
  Vec3 middle;     // origin of local coordinates
  Box embree_box;  // of what Embree holds, in local coordinates
  std::optional<SphereGrid> grid;
  std::optional<EmbreeScene> embree;  // of the triangles, and of the spheres without a grid

  void add_spheres(PowderBed const& bed);
  LocalRay local(Ray const& ray) const;
  Hit global(LocalHit const& hit) const;
  LocalHit embree_hit_around(LocalRay ray, double limit) const;
};

void BedScene::Data::add_spheres(PowderBed const& bed) {
  grain_radius = bed.radius;
  grain_material = bed.material;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    Vec3 const centre = bed.position(i) - middle;
    for (double const dx : image_offsets(bed.x[i], bed.radius[i], period[0])) {
      for (double const dy : image_offsets(bed.y[i], bed.radius[i], period[1])) {
        spheres.push_back({centre.x() + dx, centre.y() + dy, centre.z(), bed.radius[i]});
        owner.push_back(static_cast<std::int32_t>(i));
      }
    }
  }
}

BedScene::BedScene(PowderBed const& bed, TriangleSurface const& substrate, std::array<double, 2> period,
                   Backend backend)
    : data_(std::make_unique<Data>()) {
  if (bed.size() == 0 && substrate.triangles.empty()) {
    throw InputError(
        "the scene to trace is empty (neither a grain nor a substrate triangle): spread a layer or give a mesh");
  }
  check_in_tile(bed, period);
  Data& data = *data_;
  data.substrate = substrate;
  data.period = period;
  Box const mesh = box_around(substrate);
  data.box = box_around(bed);
  data.box.include(mesh.lower, mesh.upper);
  data.middle = 0.5 * (data.box.lower + data.box.upper);
  data.add_spheres(bed);

  if (backend != Backend::embree && bed.size() > 0)
    data.grid.emplace(data.spheres, std::array{-data.middle.x(), -data.middle.y()}, period);
  if (backend == Backend::automatic && data.grid && data.grid->crowding() > max_crowding) data.grid.reset();
  bool const in_grid = data.grid.has_value();
  if (in_grid && substrate.triangles.empty()) return;
  data.embree_box = in_grid ? mesh : data.box;
  data.embree_box.shift(-data.middle);
  data.embree.emplace(in_grid ? std::span<Sphere const>{} : data.spheres, substrate, data.middle);
}

BedScene::~BedScene() = default;
BedScene::BedScene(BedScene&&) noexcept = default;

LocalRay BedScene::Data::local(Ray const& ray) const {
  Vec3 const origin = ray.origin - middle;
  return {origin.x(), origin.y(), origin.z(), ray.direction.x(), ray.direction.y(), ray.direction.z()};
}

Hit BedScene::Data::global(LocalHit const& hit) const {
  if (hit.sphere >= 0)
    return {Target::grain, owner[static_cast<std::size_t>(hit.sphere)], hit.point + middle, hit.normal};
  if (hit.triangle >= 0) return {Target::substrate, hit.triangle, hit.point + middle, hit.normal};
  return {.target = hit.undecided ? Target::undecided : Target::nothing};
}

/// Tile by tile.
LocalHit BedScene::Data::embree_hit_around(LocalRay ray, double limit) const {
  std::array const direction{ray.dx, ray.dy, ray.dz};
  std::array<double*, 3> const at{&ray.ox, &ray.oy, &ray.oz};
  std::array<double, 2> from;  // lower corner of the tile
  for (std::size_t axis = 0; axis < 2; ++axis) {
    from[axis] = -middle[static_cast<Eigen::Index>(axis)];
    if (period[axis] > 0) *at[axis] -= period[axis] * std::floor((*at[axis] - from[axis]) / period[axis]);
  }
  for (int crossing = 0; crossing < max_crossings; ++crossing) {
    double const last = ray.oz + limit * ray.dz;  // not a number on a level ray without limit: goes on
    if (std::min(ray.oz, last) > embree_box.upper.z() || std::max(ray.oz, last) < embree_box.lower.z()) return {};
    double distance = limit;  // to where the ray leaves the tile
    std::size_t side = 2;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      // Sideways out of the open side.
      auto const a = static_cast<Eigen::Index>(axis);
      bool const beyond = (direction[axis] >= 0 && *at[axis] > embree_box.upper[a]) ||
                          (direction[axis] <= 0 && *at[axis] < embree_box.lower[a]);
      if (!(period[axis] > 0) && beyond) return {};
      if (!(period[axis] > 0) || direction[axis] == 0) continue;
      double const edge = from[axis] + (direction[axis] > 0 ? period[axis] : 0.0);
      double const to_edge = std::max((edge - *at[axis]) / direction[axis], 0.0);
      if (to_edge < distance) distance = to_edge, side = axis;
    }
    LocalHit const hit = embree->first_hit(ray, distance);
    if (hit.sphere >= 0 || hit.triangle >= 0 || side == 2) return hit;

    for (std::size_t axis = 0; axis < 3; ++axis) *at[axis] += distance * direction[axis];
    *at[side] = from[side] + (direction[side] > 0 ? 0.0 : period[side]);
    limit -= distance;
  }
  LocalHit lost;
  lost.undecided = true;
  return lost;
}

Hit BedScene::first_hit(Ray const& ray) const {
  LocalRay const local = data_->local(ray);
  if (!data_->grid) return data_->global(data_->embree_hit_around(local, infinity));
  LocalHit const hit = data_->grid->first_hit(local);
  if (data_->embree) {
    LocalHit const triangle = data_->embree_hit_around(local, hit.distance);
    if (triangle.triangle >= 0) return data_->global(triangle);
  }
  return data_->global(hit);
}

Hit BedScene::first_hit_in_tile(Ray const& ray) const {
  LocalRay const local = data_->local(ray);
  LocalHit const hit = data_->grid ? data_->grid->first_hit_in_tile(local, infinity) : LocalHit{};
  LocalHit const other = data_->embree ? data_->embree->first_hit(local, hit.distance) : LocalHit{};
  return data_->global(other.sphere >= 0 || other.triangle >= 0 ? other : hit);
}

bool BedScene::is_blocked(Ray const& ray, double distance) const {
  LocalRay const local = data_->local(ray);
  return (data_->grid && data_->grid->first_hit_in_tile(local, distance).sphere >= 0) ||
         (data_->embree && data_->embree->is_blocked(local, distance));
}

Backend BedScene::backend() const { return data_->grid ? Backend::grid : Backend::embree; }
std::int32_t BedScene::grains() const { return static_cast<std::int32_t>(data_->grain_radius.size()); }
double BedScene::radius(std::int32_t row) const { return data_->grain_radius[static_cast<std::size_t>(row)]; }
std::int32_t BedScene::material(std::int32_t row) const { return data_->grain_material[static_cast<std::size_t>(row)]; }
TriangleSurface const& BedScene::substrate() const { return data_->substrate; }
std::array<double, 2> const& BedScene::period() const { return data_->period; }
Vec3 const& BedScene::lower() const { return data_->box.lower; }
Vec3 const& BedScene::upper() const { return data_->box.upper; }

}  // namespace layerloop::raytrace
