#include "raytrace/ray_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "raytrace/sphere.hpp"

namespace layerloop::raytrace {
namespace {

constexpr std::int64_t block_rays = 256;    ///< traced as one piece; fixed, so that sums do not depend on the threads
constexpr std::int64_t chunk_blocks = 512;  ///< kept until their deposits are added, in order

/// Rays [begin, end) of a replicate.
struct Block {
  std::int64_t replicate, begin, end;
};

/// Random numbers of one replicate: the shift of its sequence, and the seed of what happens along its paths.
struct Draw {
  Draw(RayProblem const& problem, std::int64_t replicate) {
    auto const u = uniform4(problem.seed, RandomStream::ray_shift, problem.id, static_cast<std::uint32_t>(replicate));
    shift = {u[0], u[1]};
    auto const bits = [](double value) { return static_cast<std::uint64_t>(value * 0x1p32); };
    scatter_seed = bits(u[2]) << 32 | bits(u[3]);
  }

  std::array<double, 2> shift;
  std::uint64_t scatter_seed;
};

/// Direction by Lambert's law: density cos/pi about the normal.
Vec3 lambert(Vec3 const& normal, double u, double v) {
  Vec3 const x = normal.unitOrthogonal(), y = normal.cross(x);
  double const sine = std::sqrt(u), angle = 2 * std::numbers::pi * v;
  return (sine * std::cos(angle) * x + sine * std::sin(angle) * y + std::sqrt(1 - u) * normal).normalized();
}

/// The ray of one path, its light and what they leave behind.
template <class Light>
class Path {
 public:
  explicit Path(RayProblem const& problem, TallyLayout const& layout)
      : problem_(problem), layout_(layout), light_(problem.sets, problem.slopes) {}

  void follow(Ray ray, std::uint64_t scatter_seed, std::int64_t index, BlockTally& tally) {
    light_.start(problem_.beam, ray.direction);
    bool lit = true;
    for (std::int64_t bounce = 0; lit && bounce < problem_.max_bounces; ++bounce) {
      Hit const hit = problem_.scene.first_hit(ray);
      if (hit.target == Target::undecided) break;
      if (hit.target == Target::nothing) {
        for (std::size_t k = 0; k < layout_.sets; ++k) end(k, layout_.escaped(k), tally);
        return;
      }
      if (light_.power(0) != 0) tally.sums[layout_.hits()] += 1;
      std::size_t const material = static_cast<std::size_t>(
          hit.target == Target::grain ? problem_.scene.material(hit.row) : problem_.substrate_material);
      Vec3 const in = ray.direction;
      ray.origin = hit.point;
      ray.direction = unit(in - 2 * in.dot(hit.normal) * hit.normal);
      light_.reflect({material, in, hit.normal, ray.direction});
      deposit(hit, material, tally);
      if (problem_.diffuse_share > 0) {
        auto const u = uniform4(scatter_seed, RandomStream::ray_scatter, static_cast<std::uint64_t>(index),
                                static_cast<std::uint32_t>(bounce));
        if (u[0] < problem_.diffuse_share) {
          ray.direction = lambert(hit.normal, u[1], u[2]);
          light_.scatter(ray.direction);
        }
      }
      lit = false;
      for (std::size_t k = 0; k < layout_.sets; ++k) {
        if (light_.power(k) > problem_.cut_off) {
          lit = true;
        } else {
          end(k, layout_.residual(k), tally);
        }
      }
    }
    for (std::size_t k = 0; k < layout_.sets; ++k) end(k, layout_.residual(k), tally);
  }

 private:
  void deposit(Hit const& hit, std::size_t material, BlockTally& tally) {
    for (std::size_t k = 0; k < layout_.sets; ++k) {
      tally.sums[layout_.absorbed(k, material)] += light_.absorbed(k);
      if (hit.target == Target::substrate) tally.sums[layout_.substrate(k)] += light_.absorbed(k);
    }
    if (light_.absorbed(0) == 0) return;
    if (layout_.depth_bins > 0) {
      tally.sums[layout_.depth(depth_bin(hit.point.z(), problem_.places, layout_.depth_bins))] += light_.absorbed(0);
    }
    if (problem_.places.any())
      tally.deposits.push_back(deposit_at(hit, light_.absorbed(0), problem_.scene, problem_.places));
  }

  /// Books what a set still carries.
  void end(std::size_t set, std::size_t figure, BlockTally& tally) {
    if (light_.power(set) == 0) return;
    tally.sums[figure] += light_.power(set);
    for (std::size_t m = 0; m < layout_.materials && problem_.slopes == Slopes::with; ++m) {
      IndexSlope const left = light_.slope(set, m);  // what is absorbed is what is no longer there
      tally.sums[layout_.slope_n(set, m)] -= left.n;
      tally.sums[layout_.slope_k(set, m)] -= left.k;
    }
    light_.end(set);
  }

  RayProblem const& problem_;
  TallyLayout const& layout_;
  Light light_;
};

template <class Light>
void trace_blocks(RayProblem const& problem, std::span<Block const> blocks, std::span<BlockTally> tallies,
                  TallyLayout const& layout, int rank, int ranks) {
  double const height = problem.scene.upper().z() + 1e-3 * (problem.scene.upper() - problem.scene.lower()).norm();
#pragma omp parallel
  {
    Path<Light> path(problem, layout);
#pragma omp for schedule(dynamic)
    for (std::size_t b = static_cast<std::size_t>(rank); b < blocks.size(); b += static_cast<std::size_t>(ranks)) {
      tallies[b].sums.assign(layout.size(), 0.0);
      Draw const draw(problem, blocks[b].replicate);
      for (std::int64_t index = blocks[b].begin; index < blocks[b].end; ++index) {
        path.follow(beam_ray(problem.beam, height, index, draw.shift), draw.scatter_seed, index, tallies[b]);
      }
    }
  }
}

/// Gives every rank the tallies of all blocks; rank p has traced blocks p, p + size, ...
void share_out(std::vector<BlockTally>& tallies, std::size_t row, Communicator const& ranks) {
  std::vector<double> sums;
  std::vector<std::int64_t> counts;
  std::vector<Deposit> deposits;
  auto const rank = static_cast<std::size_t>(ranks.rank()), size = static_cast<std::size_t>(ranks.size());
  for (std::size_t b = rank; b < tallies.size(); b += size) {
    sums.insert(sums.end(), tallies[b].sums.begin(), tallies[b].sums.end());
    deposits.insert(deposits.end(), tallies[b].deposits.begin(), tallies[b].deposits.end());
    counts.push_back(static_cast<std::int64_t>(tallies[b].deposits.size()));
  }
  sums = ranks.all_gather(sums);
  counts = ranks.all_gather(counts);
  deposits = ranks.all_gather(deposits);

  auto next_sums = sums.begin();
  auto next_count = counts.begin();
  auto next_deposits = deposits.begin();
  for (std::size_t p = 0; p < size; ++p) {
    for (std::size_t b = p; b < tallies.size(); b += size) {
      tallies[b].sums.assign(next_sums, next_sums + static_cast<std::ptrdiff_t>(row));
      next_sums += static_cast<std::ptrdiff_t>(row);
      tallies[b].deposits.assign(next_deposits, next_deposits + *next_count);
      next_deposits += *next_count++;
    }
  }
}

}  // namespace

void trace_rays(RayProblem const& problem, std::int64_t last, RayTally& tally, Communicator const* ranks) {
  std::vector<Block> blocks;
  for (std::int64_t r = 0; r < static_cast<std::int64_t>(tally.replicate.size()); ++r) {
    for (std::int64_t begin = tally.replicate_rays; begin < last; begin += block_rays) {
      blocks.push_back({r, begin, std::min(begin + block_rays, last)});
    }
  }
  auto const trace =
      problem.polarisation == Polarisation::tracked ? trace_blocks<TrackedLight> : trace_blocks<AveragedLight>;
  for (std::size_t from = 0; from < blocks.size(); from += chunk_blocks) {
    auto const chunk = std::span(blocks).subspan(from, std::min<std::size_t>(chunk_blocks, blocks.size() - from));
    std::vector<BlockTally> tallies(chunk.size());
    trace(problem, chunk, tallies, tally.layout, ranks ? ranks->rank() : 0, ranks ? ranks->size() : 1);
    if (ranks && ranks->size() > 1) share_out(tallies, tally.layout.size(), *ranks);
    for (std::size_t b = 0; b < chunk.size(); ++b) {
      tally.add(tallies[b], static_cast<std::size_t>(chunk[b].replicate));
    }
  }
  tally.replicate_rays = last;
}

void check_problem(RayProblem const& problem) {
  check_beam(problem.beam);
  BedScene const& scene = problem.scene;
  std::int32_t highest = problem.substrate_material, lowest = problem.substrate_material;
  for (std::int32_t row = 0; row < scene.grains(); ++row) {
    highest = std::max(highest, scene.material(row));
    lowest = std::min(lowest, scene.material(row));
  }
  if (lowest < 0) {
    throw InputError(fmt::format("material {} does not exist (materials count from 0): check the bed's file", lowest));
  }
  check_surfaces(problem.sets, static_cast<std::size_t>(highest) + 1);
  if (problem.polarisation == Polarisation::averaged && problem.beam.polarisation != BeamPolarisation::unpolarised) {
    throw InputError(
        "a polarised beam needs its polarisation tracked (light that is averaged at every hit has none): track it, or "
        "make the beam unpolarised");
  }
  if (!(problem.diffuse_share >= 0 && problem.diffuse_share <= 1)) {
    throw InputError(
        fmt::format("a diffuse share of {:g} cannot be (0: mirror, 1: Lambert's law): check "
                    "optics.diffuse_share",
                    problem.diffuse_share));
  }
  if (!(problem.cut_off >= 0 && problem.cut_off < 1 && problem.max_bounces > 0)) {
    throw InputError(
        fmt::format("rays that end at {:g} of their power or after {} hits absorb nothing: the cut-off "
                    "lies in [0, 1), and one hit at least must be allowed",
                    problem.cut_off, problem.max_bounces));
  }
}

}  // namespace layerloop::raytrace
