#include "raytrace/embree_scene.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <type_traits>

namespace layerloop::raytrace {
namespace {

/// What an Embree callback sees of a query: the ray in double precision and its nearest sphere so far.
struct Query {
  RTCIntersectContext context;  // first: callbacks get its address
  LocalRay ray;
  double distance;
};
static_assert(std::is_standard_layout_v<Query>);

double entry_distance(Sphere const& sphere, LocalRay const& ray) {
  return entry_distance<double>(sphere.x - ray.ox, sphere.y - ray.oy, sphere.z - ray.oz, sphere.radius, ray);
}

/// Smallest float that is not below the value: a limit that Embree may safely prune with.
float rounded_up(double value) {
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
  double const distance = entry_distance(static_cast<Sphere const*>(args->geometryUserPtr)[args->primID], query.ray);
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
  double const distance = entry_distance(static_cast<Sphere const*>(args->geometryUserPtr)[args->primID], query.ray);
  if (distance <= ray.tfar) ray.tfar = -std::numeric_limits<float>::infinity();
}

void reject_back_faces(RTCFilterFunctionNArguments const* args) {
  RTCRay const& ray = *reinterpret_cast<RTCRay const*>(args->ray);
  RTCHit const& hit = *reinterpret_cast<RTCHit const*>(args->hit);
  if (ray.dir_x * hit.Ng_x + ray.dir_y * hit.Ng_y + ray.dir_z * hit.Ng_z >= 0) args->valid[0] = 0;
}

void set_ray(RTCRay& out, LocalRay const& ray, double limit) {
  out = {};
  out.org_x = static_cast<float>(ray.ox);
  out.org_y = static_cast<float>(ray.oy);
  out.org_z = static_cast<float>(ray.oz);
  out.dir_x = static_cast<float>(ray.dx);
  out.dir_y = static_cast<float>(ray.dy);
  out.dir_z = static_cast<float>(ray.dz);
  out.tnear = 0;
  out.tfar = rounded_up(limit);
  out.mask = ~0u;
}

}  // namespace

void EmbreeScene::Release::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

void EmbreeScene::attach_spheres(RTCDeviceTy* device) {
  RTCGeometry const geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres_.size()));
  rtcSetGeometryUserData(geometry, const_cast<Sphere*>(spheres_.data()));
  rtcSetGeometryBoundsFunction(
      geometry, [](RTCBoundsFunctionArguments const* args) { sphere_bounds(args); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_sphere);
  rtcSetGeometryOccludedFunction(geometry, occlude_sphere);
  rtcCommitGeometry(geometry);
  sphere_geometry_ = rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
}

void EmbreeScene::attach_triangles(RTCDeviceTy* device, TriangleSurface const& triangles, Vec3 const& middle) {
  RTCGeometry const geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), triangles.vertices.size()));
  auto* const corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.triangles.size()));
  if (!vertices || !corners) throw std::runtime_error("Embree has no memory for the substrate's triangles");
  for (std::size_t v = 0; v < triangles.vertices.size(); ++v) {
    Vec3 const local = triangles.vertices[v] - middle;
    for (std::size_t c = 0; c < 3; ++c) vertices[3 * v + c] = static_cast<float>(local[static_cast<Eigen::Index>(c)]);
  }
  for (std::size_t t = 0; t < triangles.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) corners[3 * t + c] = static_cast<unsigned>(triangles.triangles[t][c]);
    normals_.push_back(triangles.normal(t));
    corners_.push_back(triangles.corner(t, 0) - middle);
  }
  rtcSetGeometryIntersectFilterFunction(geometry, reject_back_faces);
  rtcSetGeometryOccludedFilterFunction(geometry, reject_back_faces);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
}

EmbreeScene::EmbreeScene(std::span<Sphere const> spheres, TriangleSurface const& triangles, Vec3 const& middle)
    : spheres_(spheres), sphere_geometry_(RTC_INVALID_GEOMETRY_ID) {
  // One build thread: the ranks of a run share the machine, and a bed is built in milliseconds.
  RTCDevice const device = rtcNewDevice("threads=1");
  if (!device) throw std::runtime_error("Embree cannot start on this processor");
  scene_.reset(rtcNewScene(device));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  if (!spheres.empty()) attach_spheres(device);
  if (!triangles.triangles.empty()) attach_triangles(device, triangles, middle);
  rtcCommitScene(scene_.get());
  RTCError const error = rtcGetDeviceError(device);
  rtcReleaseDevice(device);  // the scene keeps it
  if (error != RTC_ERROR_NONE) {
    throw std::runtime_error(fmt::format("Embree could not build the scene (error {})", static_cast<int>(error)));
  }
}

LocalHit EmbreeScene::first_hit(LocalRay const& ray, double limit) const {
  // Embree stops the program when a ray is not a number: it meets nothing.
  if (!std::isfinite(ray.ox + ray.oy + ray.oz + ray.dx + ray.dy + ray.dz)) return {};
  Query query;
  rtcInitIntersectContext(&query.context);
  query.ray = ray;
  query.distance = infinity;
  RTCRayHit rayhit;
  set_ray(rayhit.ray, ray, limit);
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.primID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &query.context, &rayhit);

  if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  LocalHit hit;
  Vec3 const origin(ray.ox, ray.oy, ray.oz), direction(ray.dx, ray.dy, ray.dz);
  unsigned const primitive = rayhit.hit.primID;
  if (rayhit.hit.geomID == sphere_geometry_) {
    Sphere const& sphere = spheres_[primitive];
    hit.sphere = static_cast<std::int32_t>(primitive);
    hit.distance = query.distance;
    hit.point = origin + hit.distance * direction;
    hit.normal = unit((1 / sphere.radius) * (hit.point - Vec3(sphere.x, sphere.y, sphere.z)));
  } else {
    hit.triangle = static_cast<std::int32_t>(primitive);
    hit.normal = normals_[primitive];
    double const approach = -direction.dot(hit.normal), height = (origin - corners_[primitive]).dot(hit.normal);
    hit.distance = std::max(approach > 1e-9 ? height / approach : static_cast<double>(rayhit.ray.tfar), 0.0);
    hit.point = origin + hit.distance * direction;
  }
  return hit;
}

bool EmbreeScene::is_blocked(LocalRay const& ray, double limit) const {
  Query query;
  rtcInitIntersectContext(&query.context);
  query.ray = ray;
  RTCRay embree_ray;
  set_ray(embree_ray, ray, limit);
  rtcOccluded1(scene_.get(), &query.context, &embree_ray);
  return embree_ray.tfar < 0;
}

}  // namespace layerloop::raytrace
