#include "raytrace/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/compensated_sum.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "raytrace/fresnel.hpp"

namespace layerloop::raytrace {
namespace {

constexpr std::int64_t block_rays = 256;  ///< traced as one piece; fixed, so that sums do not depend on the threads

/// Light whose polarisation is forgotten between hits.
struct AveragedLight {
  double power = 1;

  void reflect(std::complex<double> refractive_index, Vec3 const& in, Vec3 const& normal, Vec3 const& /*out*/) {
    power *= fresnel_reflectance(refractive_index, -in.dot(normal)).average();
  }
};

/// Unpolarised light as two incoherent beams of half the power, linearly polarised across each other; their complex
/// fields are followed from hit to hit.
struct TrackedLight {
  double power = 1;
  std::array<Eigen::Vector3cd, 2> field{std::sqrt(0.5) * Eigen::Vector3cd::UnitX(),
                                        std::sqrt(0.5) * Eigen::Vector3cd::UnitY()};

  void reflect(std::complex<double> refractive_index, Vec3 const& in, Vec3 const& normal, Vec3 const& out) {
    Vec3 const across = in.cross(normal);
    // At normal incidence every direction across the ray will do.
    Vec3 const s = across.norm() > 1e-9 ? across.normalized() : in.unitOrthogonal();
    Vec3 const p_in = s.cross(in), p_out = s.cross(out);
    FresnelAmplitudes const ratio = fresnel_amplitudes(refractive_index, -in.dot(normal));
    power = 0;
    for (Eigen::Vector3cd& e : field) {
      std::complex<double> const along_s = s.cast<std::complex<double>>().dot(e),
                                 along_p = p_in.cast<std::complex<double>>().dot(e);
      e = (ratio.s * along_s) * s + (ratio.p * along_p) * p_out;
      power += e.squaredNorm();
    }
  }
};

struct Deposit {
  std::int64_t cell;
  double watts;
};

/// What one block of rays leaves behind [W].
struct Tally {
  std::vector<Deposit> deposits;
  double absorbed = 0, escaped = 0, residual = 0, outside_grid = 0;
  std::int64_t hits = 0;
};

/// What every ray needs to know.
struct Setting {
  BedScene const& scene;
  std::span<std::complex<double> const> refractive_index;
  std::int32_t substrate_material;
  VoxelGrid const& grid;
  TraceSettings const& settings;

  std::complex<double> index_at(Hit const& hit) const {
    std::int32_t const material = hit.target == Target::grain ? scene.material(hit.row) : substrate_material;
    return refractive_index[static_cast<std::size_t>(material)];
  }
};

void deposit(Setting const& setting, Hit const& hit, double watts, Tally& tally) {
  VoxelGrid const& grid = setting.grid;
  double depth = 0.5 * grid.cell;  // so that the cell holds metal, not the gas in front of it
  if (hit.target == Target::grain) depth = std::min(depth, 0.5 * setting.scene.radius(hit.row));
  Vec3 point = hit.point - depth * hit.normal;
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    double const period = setting.scene.period()[static_cast<std::size_t>(axis)], from = grid.origin[axis];
    if (period > 0) point[axis] -= period * std::floor((point[axis] - from) / period);
  }
  tally.absorbed += watts;
  std::array<std::int64_t, 3> const c = grid.locate(point);
  if (grid.contains(c)) {
    tally.deposits.push_back({grid.index(c[0], c[1], c[2]), watts});
  } else {
    tally.outside_grid += watts;
  }
}

/// Follows one ray that carries `watts` until it leaves the scene or is cut off.
template <class Light>
void follow(Setting const& setting, Ray ray, double watts, Tally& tally) {
  Light light;
  for (std::int64_t bounce = 0; bounce < setting.settings.max_bounces && light.power > setting.settings.cut_off;
       ++bounce) {
    Hit const hit = setting.scene.first_hit(ray);
    if (hit.target == Target::undecided) break;
    if (hit.target == Target::nothing) {
      tally.escaped += watts * light.power;
      return;
    }
    ++tally.hits;
    Vec3 const in = ray.direction;
    ray.origin = hit.point;
    ray.direction = (in - 2 * in.dot(hit.normal) * hit.normal).normalized();
    double const before = light.power;
    light.reflect(setting.index_at(hit), in, hit.normal, ray.direction);
    deposit(setting, hit, watts * (before - light.power), tally);
  }
  tally.residual += watts * light.power;
}

template <class Light>
std::vector<Tally> trace_blocks(Setting const& setting, Beam const& beam, std::int64_t replicate_rays) {
  TraceSettings const& settings = setting.settings;
  std::int64_t const replicate_blocks = (replicate_rays + block_rays - 1) / block_rays;
  std::int64_t const blocks = settings.replicates * replicate_blocks;
  double const watts = beam.power / static_cast<double>(settings.replicates * replicate_rays);
  double const height = setting.scene.upper().z() + 1e-3 * (setting.scene.upper() - setting.scene.lower()).norm();

  std::vector<Tally> tallies(static_cast<std::size_t>(blocks));
#pragma omp parallel for schedule(dynamic)
  for (std::int64_t block = 0; block < blocks; ++block) {
    std::int64_t const replicate = block / replicate_blocks, begin = block % replicate_blocks * block_rays;
    auto const u = uniform4(settings.seed, RandomStream::ray_shift, settings.id, static_cast<std::uint32_t>(replicate));
    Tally& tally = tallies[static_cast<std::size_t>(block)];
    for (std::int64_t index = begin; index < std::min(begin + block_rays, replicate_rays); ++index) {
      follow<Light>(setting, beam_ray(beam, height, index, {u[0], u[1]}), watts, tally);
    }
  }
  return tallies;
}

/// Standard error of the mean absorptivity from the replicates.
double standard_error(std::vector<Tally> const& tallies, std::int64_t replicates, double replicate_watts) {
  std::size_t const replicate_blocks = tallies.size() / static_cast<std::size_t>(replicates);
  double mean = 0, squares = 0;
  for (std::int64_t r = 0; r < replicates; ++r) {  // Welford's update
    double absorbed = 0;
    for (std::size_t b = 0; b < replicate_blocks; ++b) {
      absorbed += tallies[static_cast<std::size_t>(r) * replicate_blocks + b].absorbed;
    }
    double const delta = absorbed / replicate_watts - mean;
    mean += delta / static_cast<double>(r + 1);
    squares += delta * (absorbed / replicate_watts - mean);
  }
  return std::sqrt(squares / static_cast<double>(replicates * (replicates - 1)));
}

AbsorbedPower add_up(std::vector<Tally> const& tallies, VoxelGrid const& grid, double incident, std::int64_t rays) {
  AbsorbedPower power;
  power.incident = incident;
  power.rays = rays;
  CompensatedSum absorbed, escaped, residual, outside;
  std::vector<CompensatedSum> cell_watts(static_cast<std::size_t>(grid.size()));
  std::int64_t hits = 0;
  for (Tally const& tally : tallies) {
    for (Deposit const& d : tally.deposits) cell_watts[static_cast<std::size_t>(d.cell)].add(d.watts);
    absorbed.add(tally.absorbed);
    escaped.add(tally.escaped);
    residual.add(tally.residual);
    outside.add(tally.outside_grid);
    hits += tally.hits;
  }
  for (std::size_t c = 0; c < cell_watts.size(); ++c) {
    if (cell_watts[c].value() == 0) continue;
    power.cell.push_back(static_cast<std::int64_t>(c));
    power.watts.push_back(cell_watts[c].value());
  }
  power.absorbed = absorbed.value();
  power.escaped = escaped.value();
  power.residual = residual.value();
  power.outside_grid = outside.value();
  power.absorptivity = power.absorbed / incident;
  power.mean_bounces = static_cast<double>(hits) / static_cast<double>(rays);
  return power;
}

void check_input(BedScene const& scene, Beam const& beam, Setting const& setting) {
  auto const fail = [](std::string const& message) { throw InputError(message); };
  TraceSettings const& settings = setting.settings;
  if (settings.rays < 1 || settings.replicates < 2) {
    fail(fmt::format(
        "{} rays in {} replicates cannot be traced (the standard error needs 2 replicates): raise optics.rays",
        settings.rays, settings.replicates));
  }
  check_beam(beam);
  std::int32_t highest = setting.substrate_material, lowest = setting.substrate_material;
  for (std::int32_t row = 0; row < scene.grains(); ++row) {
    highest = std::max(highest, scene.material(row));
    lowest = std::min(lowest, scene.material(row));
  }
  if (lowest < 0 || highest >= static_cast<std::int32_t>(setting.refractive_index.size())) {
    fail(fmt::format(
        "material {} has no refractive index ({} are given): name one for every material of bed and substrate",
        lowest < 0 ? lowest : highest, setting.refractive_index.size()));
  }
  for (std::complex<double> const N : setting.refractive_index) {
    if (!(N.real() > 0 && N.imag() >= 0)) {
      fail(fmt::format(
          "refractive index {:g} + {:g}i is not that of a metal (n > 0, k >= 0): check optics.refractive_index",
          N.real(), N.imag()));
    }
  }
}

void check_result(AbsorbedPower const& power, Beam const& beam, BedScene const& scene) {
  CompensatedSum placed;
  placed.add(power.outside_grid);
  for (double const watts : power.watts) placed.add(watts);
  double const error = std::max(ray_energy_error(power), std::abs(placed.value() - power.absorbed) / power.incident);
  if (!(error < 1e-12)) {
    throw PhysicsError(
        fmt::format("the ledger of the trace does not close (incident {:g} W, absorbed {:g} W, escaped {:g} W, "
                    "residual {:g} W, relative error {:g}); look for coordinates or refractive indices that are "
                    "not numbers",
                    power.incident, power.absorbed, power.escaped, power.residual, error));
  }
  if (!(power.absorbed > 0)) {
    throw PhysicsError(fmt::format(
        "the beam at x = {:g} m, y = {:g} m is not absorbed at all (bed and substrate span x = {:g} "
        "to {:g} m, y = {:g} to {:g} m): check the scan path and optics.refractive_index",
        beam.centre.x(), beam.centre.y(), scene.lower().x(), scene.upper().x(), scene.lower().y(), scene.upper().y()));
  }
  if (power.absorbed > power.incident * (1 + 1e-12)) {
    throw PhysicsError(
        fmt::format("more power was absorbed than fell in ({:g} of {:g} W): check optics.refractive_index",
                    power.absorbed, power.incident));
  }
}

}  // namespace

AbsorbedPower trace(BedScene const& scene, Beam const& beam, std::span<std::complex<double> const> refractive_index,
                    std::int32_t substrate_material, VoxelGrid const& grid, TraceSettings const& settings) {
  Setting const setting{scene, refractive_index, substrate_material, grid, settings};
  check_input(scene, beam, setting);

  std::int64_t const replicate_rays = (settings.rays + settings.replicates - 1) / settings.replicates;
  std::vector<Tally> const tallies = settings.polarisation == Polarisation::tracked
                                         ? trace_blocks<TrackedLight>(setting, beam, replicate_rays)
                                         : trace_blocks<AveragedLight>(setting, beam, replicate_rays);

  AbsorbedPower power = add_up(tallies, grid, beam.power, settings.replicates * replicate_rays);
  power.standard_error =
      standard_error(tallies, settings.replicates, beam.power / static_cast<double>(settings.replicates));
  check_result(power, beam, scene);
  return power;
}

}  // namespace layerloop::raytrace
