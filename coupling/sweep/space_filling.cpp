#include "coupling/sweep/space_filling.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <limits>
#include <numeric>

#include "core/random.hpp"

namespace layerloop::coupling {
namespace {

UnitPoints hypercube_draw(std::size_t points, std::size_t dimensions, std::uint64_t seed, std::uint32_t draw) {
  UnitPoints all(points, std::vector<double>(dimensions));
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::vector<std::array<double, 4>> random(points);
    for (std::size_t k = 0; k < points; ++k) random[k] = uniform4(seed, RandomStream::design, k * dimensions + d, draw);
    std::vector<std::size_t> slice(points);
    std::iota(slice.begin(), slice.end(), std::size_t{0});
    std::ranges::stable_sort(slice, {}, [&](std::size_t k) { return random[k][0]; });
    for (std::size_t k = 0; k < points; ++k)
      all[k][d] = (static_cast<double>(slice[k]) + random[k][1]) / static_cast<double>(points);
  }
  return all;
}

/// Square of the distance of the two nearest points.
double least_distance(UnitPoints const& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      double square = 0;
      for (std::size_t d = 0; d < points[a].size(); ++d)
        square += (points[a][d] - points[b][d]) * (points[a][d] - points[b][d]);
      least = std::min(least, square);
    }
  }
  return least;
}

}  // namespace

UnitPoints latin_hypercube(std::int64_t points, std::size_t dimensions, std::uint64_t seed) {
  constexpr std::uint32_t draws = 200;
  UnitPoints best;
  double widest = -1;
  for (std::uint32_t draw = 0; draw < draws; ++draw) {
    UnitPoints next = hypercube_draw(static_cast<std::size_t>(points), dimensions, seed, draw);
    double const distance = least_distance(next);
    if (distance <= widest) continue;
    widest = distance;
    best = std::move(next);
    if (points < 2 || points > 500) break;  // of many points all draws are alike
  }
  return best;
}

UnitPoints sobol_points(std::int64_t points, std::size_t dimensions, std::uint64_t seed) {
  boost::random::sobol sequence(dimensions);
  std::vector<std::uint64_t> shift(dimensions);
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::array<double, 4> const u = uniform4(seed, RandomStream::design, d);
    shift[d] = (static_cast<std::uint64_t>(u[0] * 0x1p32) << 32) | static_cast<std::uint64_t>(u[1] * 0x1p32);
  }
  UnitPoints all(static_cast<std::size_t>(points), std::vector<double>(dimensions));
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t d = 0; d < dimensions; ++d) {
      std::uint64_t const digits = k == 0 ? 0 : sequence();  // the library leaves out the first point, the origin
      all[k][d] = static_cast<double>((digits ^ shift[d]) >> 11) * 0x1p-53;
    }
  }
  return all;
}

}  // namespace layerloop::coupling
