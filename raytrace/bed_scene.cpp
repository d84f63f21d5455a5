#include "raytrace/bed_scene.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "core/error.hpp"

namespace layerloop::raytrace {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int max_crossings = 10000;

/// In scene coordinates, double precision.
struct alignas(32) Sphere {
  double x, y, z, radius;
};

/// What an Embree callback sees of a query: the ray in double precision and its nearest grain so far.
struct Query {
  RTCIntersectContext context;  // first: callbacks get its address
  double ox, oy, oz, dx, dy, dz;
  double distance;
};
static_assert(std::is_standard_layout_v<Query>);

/// Distance at which the ray enters the sphere from outside; infinity when it does not.
inline double entry_distance(Sphere const& sphere, Query const& query) {
  double const cx = sphere.x - query.ox, cy = sphere.y - query.oy, cz = sphere.z - query.oz;
  double const ahead = cx * query.dx + cy * query.dy + cz * query.dz;
  if (!(ahead > 0)) return infinity;  // the centre lies behind: also the sphere that the ray has just left
  // The distance of the centre from the ray by its components, not as |c|^2 - ahead^2, which cancels.
  double const px = cx - ahead * query.dx, py = cy - ahead * query.dy, pz = cz - ahead * query.dz;
  double const inside = sphere.radius * sphere.radius - (px * px + py * py + pz * pz);
  if (!(inside > 0)) return infinity;
  double const distance = ahead - std::sqrt(inside);
  return distance >= 0 ? distance : infinity;
}

/// Smallest float that is not below the value: a limit that Embree may safely prune with.
inline float rounded_up(double value) {
  float const nearest = static_cast<float>(value);
  return nearest >= value ? nearest : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

void sphere_bounds(RTCBoundsFunctionArguments const* args) {
  Sphere const& s = static_cast<Sphere const*>(args->geometryUserPtr)[args->primID];
  // Room for the rounding of box and ray to single precision.
  double const reach = std::max({std::abs(s.x), std::abs(s.y), std::abs(s.z)});
  double const r = s.radius * (1 + 1e-5) + 1e-6 * reach;
  *args->bounds_o = {static_cast<float>(s.x - r), static_cast<float>(s.y - r), static_cast<float>(s.z - r), 0,
                     static_cast<float>(s.x + r), static_cast<float>(s.y + r), static_cast<float>(s.z + r), 0};
}

void intersect_sphere(RTCIntersectFunctionNArguments const* args) {
  if (!args->valid[0]) return;
  Query& query = *reinterpret_cast<Query*>(args->context);
  RTCRayHit& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  double const distance = entry_distance(static_cast<Sphere const*>(args->geometryUserPtr)[args->primID], query);
  if (!(distance < query.distance && distance <= rayhit.ray.tfar)) return;
  query.distance = distance;
  rayhit.ray.tfar = rounded_up(distance);
  rayhit.hit.primID = args->primID;
  rayhit.hit.geomID = args->geomID;
}

void occlude_sphere(RTCOccludedFunctionNArguments const* args) {
  if (!args->valid[0]) return;
  Query const& query = *reinterpret_cast<Query const*>(args->context);
  RTCRay& ray = *reinterpret_cast<RTCRay*>(args->ray);
  double const distance = entry_distance(static_cast<Sphere const*>(args->geometryUserPtr)[args->primID], query);
  if (distance <= ray.tfar) ray.tfar = -std::numeric_limits<float>::infinity();
}

void reject_back_faces(RTCFilterFunctionNArguments const* args) {
  RTCRay const& ray = *reinterpret_cast<RTCRay const*>(args->ray);
  RTCHit const& hit = *reinterpret_cast<RTCHit const*>(args->hit);
  if (ray.dir_x * hit.Ng_x + ray.dir_y * hit.Ng_y + ray.dir_z * hit.Ng_z >= 0) args->valid[0] = 0;
}

}  // namespace

struct BedScene::Data {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  unsigned sphere_geometry = RTC_INVALID_GEOMETRY_ID;
  std::vector<Sphere> spheres;      // grains, then copies across periodic edges
  std::vector<std::int32_t> owner;  // row of the grain in the bed
  std::vector<double> grain_radius;
  std::vector<std::int32_t> grain_material;
  TriangleSurface substrate;
  std::vector<Vec3> normals;  // of the substrate's triangles
  std::array<double, 2> period{};
  Vec3 lower = Vec3::Constant(infinity), upper = Vec3::Constant(-infinity);
  Vec3 middle = Vec3::Zero();  // origin of scene coordinates

  ~Data() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void add_spheres(PowderBed const& bed);
  void find_box(PowderBed const& bed);
  void attach_spheres();
  void attach_triangles();
  Query query(Ray const& ray) const;
  Hit nearest(Ray const& ray, double limit) const;
};

namespace {

/// Offsets by which a grain must be copied along one axis: none, and one period when it reaches over an edge.
std::vector<double> image_offsets(double centre, double radius, double period) {
  std::vector<double> offsets{0};
  if (period > 0 && centre < radius) offsets.push_back(period);
  if (period > 0 && centre > period - radius) offsets.push_back(-period);
  return offsets;
}

void set_ray(RTCRay& ray, Query const& query, double limit) {
  ray = {};
  ray.org_x = static_cast<float>(query.ox);
  ray.org_y = static_cast<float>(query.oy);
  ray.org_z = static_cast<float>(query.oz);
  ray.dir_x = static_cast<float>(query.dx);
  ray.dir_y = static_cast<float>(query.dy);
  ray.dir_z = static_cast<float>(query.dz);
  ray.tnear = 0;
  ray.tfar = rounded_up(limit);
  ray.mask = ~0u;
}

}  // namespace

void BedScene::Data::find_box(PowderBed const& bed) {
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (!(bed.position(i).allFinite() && bed.radius[i] > 0)) {
      throw PhysicsError(
          fmt::format("grain {} cannot be traced (centre {:g}, {:g}, {:g} m, radius {:g} m): the stage that moved "
                      "it has failed; try a smaller time step",
                      bed.id[i], bed.x[i], bed.y[i], bed.z[i], bed.radius[i]));
    }
    lower = lower.cwiseMin(bed.position(i) - Vec3::Constant(bed.radius[i]));
    upper = upper.cwiseMax(bed.position(i) + Vec3::Constant(bed.radius[i]));
  }
  for (Vec3 const& vertex : substrate.vertices) {
    if (!vertex.allFinite()) throw PhysicsError("the substrate has a corner that is not a number: check its mesh");
    lower = lower.cwiseMin(vertex);
    upper = upper.cwiseMax(vertex);
  }
  middle = 0.5 * (lower + upper);
}

void BedScene::Data::add_spheres(PowderBed const& bed) {
  grain_radius = bed.radius;
  grain_material = bed.material;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      double const centre = axis == 0 ? bed.x[i] : bed.y[i];
      if (period[axis] > 0 && !(centre >= 0 && centre <= period[axis])) {
        throw InputError(
            fmt::format("grain {} has its centre at {} = {:g} m (outside the periodic tile [0, {:g}) m): wrap it "
                        "into the tile before tracing",
                        bed.id[i], axis == 0 ? "x" : "y", centre, period[axis]));
      }
    }
    Vec3 const centre = bed.position(i) - middle;
    for (double const dx : image_offsets(bed.x[i], bed.radius[i], period[0])) {
      for (double const dy : image_offsets(bed.y[i], bed.radius[i], period[1])) {
        spheres.push_back({centre.x() + dx, centre.y() + dy, centre.z(), bed.radius[i]});
        owner.push_back(static_cast<std::int32_t>(i));
      }
    }
  }
}

void BedScene::Data::attach_spheres() {
  RTCGeometry const geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres.size()));
  rtcSetGeometryUserData(geometry, spheres.data());
  rtcSetGeometryBoundsFunction(
      geometry, [](RTCBoundsFunctionArguments const* args) { sphere_bounds(args); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_sphere);
  rtcSetGeometryOccludedFunction(geometry, occlude_sphere);
  rtcCommitGeometry(geometry);
  sphere_geometry = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

void BedScene::Data::attach_triangles() {
  RTCGeometry const geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), substrate.vertices.size()));
  auto* const corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), substrate.triangles.size()));
  if (!vertices || !corners) throw std::runtime_error("Embree has no memory for the substrate's triangles");
  for (std::size_t v = 0; v < substrate.vertices.size(); ++v) {
    Vec3 const local = substrate.vertices[v] - middle;
    for (std::size_t c = 0; c < 3; ++c) vertices[3 * v + c] = static_cast<float>(local[static_cast<Eigen::Index>(c)]);
  }
  for (std::size_t t = 0; t < substrate.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) corners[3 * t + c] = static_cast<unsigned>(substrate.triangles[t][c]);
    normals.push_back(substrate.normal(t));
  }
  rtcSetGeometryIntersectFilterFunction(geometry, reject_back_faces);
  rtcSetGeometryOccludedFilterFunction(geometry, reject_back_faces);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

BedScene::BedScene(PowderBed const& bed, TriangleSurface const& substrate, std::array<double, 2> period)
    : data_(std::make_unique<Data>()) {
  if (bed.size() == 0 && substrate.triangles.empty()) {
    throw InputError(
        "the scene to trace is empty (neither a grain nor a substrate triangle): spread a layer or give a mesh");
  }
  data_->substrate = substrate;
  data_->period = period;
  data_->find_box(bed);
  data_->add_spheres(bed);

  // One build thread: the ranks of a run share the machine, and a bed is built in milliseconds.
  data_->device = rtcNewDevice("threads=1");
  if (!data_->device) throw std::runtime_error("Embree cannot start on this processor");
  data_->scene = rtcNewScene(data_->device);
  rtcSetSceneFlags(data_->scene, RTC_SCENE_FLAG_ROBUST);
  if (!data_->spheres.empty()) data_->attach_spheres();
  if (!substrate.triangles.empty()) data_->attach_triangles();
  rtcCommitScene(data_->scene);
  if (RTCError const error = rtcGetDeviceError(data_->device); error != RTC_ERROR_NONE) {
    throw std::runtime_error(fmt::format("Embree could not build the scene (error {})", static_cast<int>(error)));
  }
}

BedScene::~BedScene() = default;
BedScene::BedScene(BedScene&&) noexcept = default;

Query BedScene::Data::query(Ray const& ray) const {
  Query query;
  rtcInitIntersectContext(&query.context);
  Vec3 const origin = ray.origin - middle;
  query.ox = origin.x(), query.oy = origin.y(), query.oz = origin.z();
  query.dx = ray.direction.x(), query.dy = ray.direction.y(), query.dz = ray.direction.z();
  query.distance = infinity;
  return query;
}

Hit BedScene::Data::nearest(Ray const& ray, double limit) const {
  Query query = this->query(ray);
  RTCRayHit rayhit;
  set_ray(rayhit.ray, query, limit);
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.primID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &query.context, &rayhit);

  Hit hit;
  if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  if (rayhit.hit.geomID == sphere_geometry) {
    Sphere const& sphere = spheres[rayhit.hit.primID];
    hit.target = Target::grain;
    hit.row = owner[rayhit.hit.primID];
    hit.point = ray.origin + query.distance * ray.direction;
    hit.normal = (hit.point - middle - Vec3(sphere.x, sphere.y, sphere.z)).normalized();
  } else {
    hit.target = Target::substrate;
    hit.row = static_cast<std::int32_t>(rayhit.hit.primID);
    hit.normal = normals[rayhit.hit.primID];
    double const approach = -ray.direction.dot(hit.normal);
    double const height = (ray.origin - substrate.corner(rayhit.hit.primID, 0)).dot(hit.normal);
    double const distance = approach > 1e-9 ? height / approach : static_cast<double>(rayhit.ray.tfar);
    hit.point = ray.origin + std::max(distance, 0.0) * ray.direction;
  }
  return hit;
}

Hit BedScene::first_hit_in_tile(Ray const& ray) const { return data_->nearest(ray, infinity); }

Hit BedScene::first_hit(Ray ray) const {
  for (std::size_t axis = 0; axis < 2; ++axis) {  // into the tile
    double const period = data_->period[axis];
    double& at = ray.origin[static_cast<Eigen::Index>(axis)];
    if (period > 0) at -= period * std::floor(at / period);
  }
  for (int crossing = 0; crossing < max_crossings; ++crossing) {
    double limit = infinity;  // where the ray leaves the tile
    Eigen::Index side = -1;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      double const period = data_->period[static_cast<std::size_t>(axis)], d = ray.direction[axis];
      if (!(period > 0) || d == 0) continue;
      double const distance = std::max(((d > 0 ? period : 0.0) - ray.origin[axis]) / d, 0.0);
      if (distance < limit) limit = distance, side = axis;
    }
    Hit hit = data_->nearest(ray, limit);
    if (hit.target != Target::nothing || side < 0) return hit;

    ray.origin += limit * ray.direction;
    ray.origin[side] = ray.direction[side] > 0 ? 0.0 : data_->period[static_cast<std::size_t>(side)];
    double const climb = ray.direction.z(), height = ray.origin.z();
    if ((climb >= 0 && height > data_->upper.z()) || (climb <= 0 && height < data_->lower.z())) return hit;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      // Sideways out of the open side.
      bool const beyond = (ray.direction[axis] >= 0 && ray.origin[axis] > data_->upper[axis]) ||
                          (ray.direction[axis] <= 0 && ray.origin[axis] < data_->lower[axis]);
      if (!(data_->period[static_cast<std::size_t>(axis)] > 0) && beyond) return hit;
    }
  }
  return {.target = Target::undecided};
}

bool BedScene::is_blocked(Ray const& ray, double distance) const {
  Query query = data_->query(ray);
  RTCRay embree_ray;
  set_ray(embree_ray, query, distance);
  rtcOccluded1(data_->scene, &query.context, &embree_ray);
  return embree_ray.tfar < 0;
}

std::int32_t BedScene::grains() const { return static_cast<std::int32_t>(data_->grain_radius.size()); }
double BedScene::radius(std::int32_t row) const { return data_->grain_radius[static_cast<std::size_t>(row)]; }
std::int32_t BedScene::material(std::int32_t row) const { return data_->grain_material[static_cast<std::size_t>(row)]; }
TriangleSurface const& BedScene::substrate() const { return data_->substrate; }
std::array<double, 2> const& BedScene::period() const { return data_->period; }
Vec3 const& BedScene::lower() const { return data_->lower; }
Vec3 const& BedScene::upper() const { return data_->upper; }

}  // namespace layerloop::raytrace
