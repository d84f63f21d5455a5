#include "raytrace/ray_bench.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/random.hpp"
#include "raytrace/absorption.hpp"
#include "raytrace/fresnel.hpp"
#include "raytrace/trace.hpp"

namespace layerloop::raytrace {
namespace {

constexpr std::complex<double> stainless_steel{3.27, 4.48};  // Boley et al., Appl. Opt. 54 (2015) 2477
constexpr int rounds = 9;
constexpr double spot_radius = 60e-6;  // [m]

double processor_time() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Processor time that it takes [s].
double timed(std::function<void()> const& work) {
  double const begin = processor_time();
  work();
  return processor_time() - begin;
}

Rate rate(std::vector<double> seconds, std::size_t count) {
  std::sort(seconds.begin(), seconds.end());
  auto const n = static_cast<double>(count);
  return {.median = n / seconds[seconds.size() / 2], .best = n / seconds.front()};
}

TriangleSurface plate_under(BedFile const& file, Vec3 const& lower, Vec3 const& upper) {
  if (!file.floor_z) return {};
  double const z = *file.floor_z, x0 = 2 * lower.x() - upper.x(), x1 = 2 * upper.x() - lower.x(),
               y0 = 2 * lower.y() - upper.y(), y1 = 2 * upper.y() - lower.y();
  return {{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// Embree at its fastest: its own spheres, no hit refined, nothing wrapped.
class BuiltInSpheres {
 public:
  BuiltInSpheres(PowderBed const& bed, TriangleSurface const& plate, std::array<double, 2> const& period,
                 Vec3 const& middle)
      : middle_(middle) {
    RTCDevice const device = rtcNewDevice("threads=1");
    scene_.reset(rtcNewScene(device));
    add_spheres(device, bed, period);
    if (!plate.triangles.empty()) add_plate(device, plate);
    rtcCommitScene(scene_.get());
    rtcReleaseDevice(device);
  }

  RTCRayHit prepared(Ray const& ray) const {
    RTCRayHit out{};
    Vec3 const origin = ray.origin - middle_;
    out.ray.org_x = static_cast<float>(origin.x());
    out.ray.org_y = static_cast<float>(origin.y());
    out.ray.org_z = static_cast<float>(origin.z());
    out.ray.dir_x = static_cast<float>(ray.direction.x());
    out.ray.dir_y = static_cast<float>(ray.direction.y());
    out.ray.dir_z = static_cast<float>(ray.direction.z());
    out.ray.tfar = std::numeric_limits<float>::infinity();
    out.ray.mask = ~0u;
    out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return out;
  }

  void intersect(RTCRayHit& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_.get(), &context, &ray);
  }

 private:
  static void reject_back_faces(RTCFilterFunctionNArguments const* args) {
    RTCRay const& ray = *reinterpret_cast<RTCRay const*>(args->ray);
    RTCHit const& hit = *reinterpret_cast<RTCHit const*>(args->hit);
    if (ray.dir_x * hit.Ng_x + ray.dir_y * hit.Ng_y + ray.dir_z * hit.Ng_z >= 0) args->valid[0] = 0;
  }

  void attach(RTCGeometry geometry) {
    rtcSetGeometryIntersectFilterFunction(geometry, reject_back_faces);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
  }

  void add_spheres(RTCDevice device, PowderBed const& bed, std::array<double, 2> const& period) {
    std::vector<std::array<float, 4>> spheres;
    for (std::size_t i = 0; i < bed.size(); ++i) {
      for (int jx = -1; jx <= 1; ++jx) {
        for (int jy = -1; jy <= 1; ++jy) {
          Vec3 const centre = bed.position(i) + Vec3(jx * period[0], jy * period[1], 0);
          double const r = bed.radius[i];
          bool const reaches_in = (jx == 0 || (period[0] > 0 && centre.x() > -r && centre.x() < period[0] + r)) &&
                                  (jy == 0 || (period[1] > 0 && centre.y() > -r && centre.y() < period[1] + r));
          if (!reaches_in) continue;
          Eigen::Vector3f const at = (centre - middle_).cast<float>();
          spheres.push_back({at.x(), at.y(), at.z(), static_cast<float>(r)});
        }
      }
    }
    RTCGeometry const geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    void* const buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                 sizeof spheres[0], spheres.size());
    std::copy(spheres.begin(), spheres.end(), static_cast<std::array<float, 4>*>(buffer));
    attach(geometry);
  }

  void add_plate(RTCDevice device, TriangleSurface const& plate) {
    RTCGeometry const geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), plate.vertices.size()));
    auto* const corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), plate.triangles.size()));
    for (std::size_t v = 0; v < plate.vertices.size(); ++v) {
      Eigen::Vector3f const at = (plate.vertices[v] - middle_).cast<float>();
      std::copy_n(at.data(), 3, vertices + 3 * v);
    }
    for (std::size_t t = 0; t < plate.triangles.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) corners[3 * t + c] = static_cast<unsigned>(plate.triangles[t][c]);
    }
    attach(geometry);
  }

  struct Release {
    void operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }
  };
  Vec3 middle_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
};

Beam beam_of(BenchLight light, std::array<double, 2> const& period, Vec3 const& lower, Vec3 const& upper) {
  Beam beam{.centre = 0.5 * (lower + upper), .power = 1, .radius = spot_radius};
  if (light == BenchLight::spot) return beam;
  beam.profile = BeamProfile::uniform;
  std::array<double*, 2> const size{&beam.size_x, &beam.size_y};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    auto const a = static_cast<Eigen::Index>(axis);
    *size[axis] = period[axis] > 0 ? period[axis] : upper[a] - lower[a];
    if (period[axis] > 0) beam.centre[a] = 0.5 * period[axis];
  }
  return beam;
}

/// The flights of a trace, as it makes them.
struct Flights {
  std::vector<Ray> first, secondary;
};

void record_path(BedScene const& scene, Ray ray, TraceSettings const& settings, Flights& flights) {
  double power = 1;
  flights.first.push_back(ray);
  for (std::int64_t bounce = 0; bounce < settings.max_bounces && power > settings.cut_off; ++bounce) {
    if (bounce > 0) flights.secondary.push_back(ray);
    Hit const hit = scene.first_hit(ray);
    if (hit.target == Target::nothing || hit.target == Target::undecided) return;
    double const cosine = -ray.direction.dot(hit.normal);
    power *= fresnel_reflectance(stainless_steel, cosine).average();
    ray = {hit.point, (ray.direction + 2 * cosine * hit.normal).normalized()};
  }
}

Flights record(BedScene const& scene, Beam const& beam, TraceSettings const& settings) {
  Flights flights;
  double const height = scene.upper().z() + 1e-3 * (scene.upper() - scene.lower()).norm();
  for (std::int64_t r = 0; r < settings.replicates; ++r) {
    auto const u = uniform4(settings.seed, RandomStream::ray_shift, settings.id, static_cast<std::uint32_t>(r));
    for (std::int64_t i = 0; i < settings.rays / settings.replicates; ++i) {
      record_path(scene, beam_ray(beam, height, i, {u[0], u[1]}), settings, flights);
    }
  }
  return flights;
}

void compare_hits(BedScene const& grid, BedScene const& embree, std::vector<Ray> const& rays, RayBench& result) {
  for (Ray const& ray : rays) {
    Hit const one = grid.first_hit(ray), other = embree.first_hit(ray);
    if (one.target == other.target && one.row == other.row) continue;
    ++result.hits_differing;
    auto const grazing = [&](Hit const& hit) {
      return hit.target == Target::grain && -ray.direction.dot(hit.normal) < 0.1;
    };
    bool const tie = one.target == other.target && (one.point - other.point).norm() < 1e-9 * grid.radius(0);
    if (!grazing(one) && !grazing(other) && !tie) ++result.hits_differing_plainly;
  }
}

VoxelGrid cells_around(BedScene const& scene) {
  Vec3 const size = scene.upper() - scene.lower();
  double const cell = size.maxCoeff() / 64;
  auto const count = [&](double length) { return static_cast<std::int32_t>(length / cell) + 2; };
  return {scene.lower() - Vec3::Constant(0.5 * cell), cell, {count(size.x()), count(size.y()), count(size.z())}};
}

/// A study of the whole bed under uniform light that stops by itself.
void find_time_to_standard_error(BedScene const& scene, RayBench& result) {
  Beam const beam = beam_of(BenchLight::uniform, scene.period(), scene.lower(), scene.upper());
  OpticalSet const steel{.name = "stainless steel", .surface = {{.refractive_index = stainless_steel}}};
  Absorption found;
  result.seconds_to_standard_error = timed([&] {
    found = absorb(scene, beam, {&steel, 1}, 0, {.rays = 4096, .target_standard_error = result.target_standard_error});
  });
  result.rays_to_standard_error = found.rays;
  result.reached_standard_error = found.sets[0].standard_error;
  result.reached_absorptivity = found.sets[0].absorptivity;
}

struct Contenders {
  BedScene const &embree, &grid, &chosen;
  BuiltInSpheres const& built_in;
};

/// All contenders in turn, so that what else the machine does meets them alike.
void time_rounds(Contenders const& of, Flights const& flights, Beam const& beam, TraceSettings const& settings,
                 RayBench& result) {
  std::vector<RTCRayHit> prepared;
  for (Ray const& ray : flights.secondary) prepared.push_back(of.built_in.prepared(ray));
  VoxelGrid const cells = cells_around(of.chosen);
  std::int64_t found = 0;
  auto const answer = [&](BedScene const& scene) {
    for (Ray const& ray : flights.secondary) found += scene.first_hit(ray).target == Target::grain;
  };
  std::vector<double> built_in, embree, grid, tracer;  // [s]
  for (int round = 0; round < rounds; ++round) {
    built_in.push_back(timed([&] {
      for (RTCRayHit const& ray : prepared) {
        RTCRayHit copy = ray;
        of.built_in.intersect(copy);
      }
    }));
    embree.push_back(timed([&] { answer(of.embree); }));
    grid.push_back(timed([&] { answer(of.grid); }));
    tracer.push_back(timed([&] { trace(of.chosen, beam, std::array{stainless_steel}, 0, cells, settings); }));
  }
  std::size_t const secondary = flights.secondary.size();
  result.hit_share = static_cast<double>(found) / static_cast<double>(2 * rounds * secondary);
  result.built_in = rate(built_in, secondary);
  result.embree = rate(embree, secondary);
  result.grid = rate(grid, secondary);
  result.tracer = rate(tracer, secondary + flights.first.size());
}

}  // namespace

RayBench bench_rays(BedFile const& file, std::int64_t rays, BenchLight light) {
  if (file.bed.size() == 0) throw InputError("the bed is empty (nothing to trace): give one with grains");
  PowderBed bed = file.bed;
  std::fill(bed.material.begin(), bed.material.end(), 0);
  std::array const period{file.periodic_x.value_or(0), file.periodic_y.value_or(0)};
  BedScene const box(bed, {}, period);
  TriangleSurface const plate = plate_under(file, box.lower(), box.upper());

  RayBench result;
  std::optional<BedScene> embree, grid;
  std::optional<BuiltInSpheres> built_in;
  result.embree_build = timed([&] { embree.emplace(bed, plate, period, Backend::embree); });
  result.grid_build = timed([&] { grid.emplace(bed, plate, period, Backend::grid); });
  Vec3 const middle = 0.5 * (box.lower() + box.upper());
  result.built_in_build = timed([&] { built_in.emplace(bed, plate, period, middle); });
  BedScene const chosen(bed, plate, period);
  result.grid_chosen = chosen.backend() == Backend::grid;

  Beam const beam = beam_of(light, period, box.lower(), box.upper());
  TraceSettings settings;
  settings.rays = std::max<std::int64_t>(rays / 6 / settings.replicates, 1) * settings.replicates;
  Flights const flights = record(*embree, beam, settings);
  result.particles = static_cast<std::int64_t>(bed.size());
  result.paths = settings.rays;
  result.secondary_rays = static_cast<std::int64_t>(flights.secondary.size());
  if (flights.secondary.empty())
    throw InputError("no ray met a grain (nothing to time): is the bed where the light is?");
  compare_hits(*grid, *embree, flights.first, result);
  compare_hits(*grid, *embree, flights.secondary, result);

  time_rounds({*embree, *grid, chosen, *built_in}, flights, beam, settings, result);
  find_time_to_standard_error(chosen, result);
  return result;
}

}  // namespace layerloop::raytrace
