#include "dem/textured_plate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/grain_size.hpp"
#include "core/random.hpp"
#include "dem/dosing.hpp"

namespace layerloop::dem {
namespace {
constexpr double pi = std::numbers::pi;
constexpr std::uint64_t modes = 400;
constexpr double points_a_length = 5;     // mesh points on one correlation length
constexpr double points_a_diameter = 10;  // and on the smallest frozen grain

struct Mode {
  double kx, ky, phase;
};

std::vector<Mode> draw_modes(Case const& checked) {
  MachineSettings const& m = checked.machine;
  double const spread = std::numbers::sqrt2 / m.plate_correlation_length, step = 2 * pi / m.width;
  std::vector<Mode> drawn;
  for (std::uint64_t k = 0; k < modes; ++k) {
    auto const u = uniform4(checked.seed, RandomStream::plate_heights, k);
    double const length = spread * std::sqrt(-2 * std::log(u[0])), turn = 2 * pi * u[1];  // Box-Muller
    drawn.push_back({length * std::cos(turn), step * std::round(length * std::sin(turn) / step), 2 * pi * u[2]});
  }
  return drawn;
}

/// Top, bottom and sides of a block with these heights, ascending by x, then y.
TriangleSurface closed_block(std::vector<double> const& x, std::vector<double> const& y,
                             std::vector<double> const& height, double bottom) {
  TriangleSurface s;
  std::size_t const nx = x.size(), ny = y.size();
  for (int top = 0; top < 2; ++top)
    for (std::size_t j = 0; j < ny; ++j)
      for (std::size_t i = 0; i < nx; ++i) s.vertices.emplace_back(x[i], y[j], top ? height[i + nx * j] : bottom);
  auto const at = [&](std::size_t i, std::size_t j, std::size_t top) {
    return static_cast<std::int32_t>(i + nx * j + nx * ny * top);
  };
  auto const quad = [&](std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({a, c, d});
  };
  for (std::size_t j = 0; j + 1 < ny; ++j)
    for (std::size_t i = 0; i + 1 < nx; ++i) {
      quad(at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1));
      quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
    }
  for (std::size_t i = 0; i + 1 < nx; ++i) {
    quad(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1));
    quad(at(i, ny - 1, 0), at(i, ny - 1, 1), at(i + 1, ny - 1, 1), at(i + 1, ny - 1, 0));
  }
  for (std::size_t j = 0; j + 1 < ny; ++j) {
    quad(at(0, j, 0), at(0, j, 1), at(0, j + 1, 1), at(0, j + 1, 0));
    quad(at(nx - 1, j, 0), at(nx - 1, j + 1, 0), at(nx - 1, j + 1, 1), at(nx - 1, j, 1));
  }
  return s;
}

std::vector<double> even_points(double from, double to, double spacing) {
  auto const cells = static_cast<std::size_t>(std::ceil((to - from) / spacing));
  std::vector<double> points(cells + 1);
  for (std::size_t i = 0; i <= cells; ++i)
    points[i] = from + (to - from) * static_cast<double>(i) / static_cast<double>(cells);
  return points;
}

/// Heights on a grid, ascending by x, then y.
class Heights {
 public:
  Heights(std::vector<double> x, std::vector<double> y)
      : x_(std::move(x)), y_(std::move(y)), z_(x_.size() * y_.size()) {}

  void add_roughness(Case const& checked) {
    MachineSettings const& m = checked.machine;
    std::vector<Mode> const drawn = draw_modes(checked);
    double const amplitude = m.plate_roughness * std::sqrt(2.0 / static_cast<double>(modes));
    for (std::size_t j = 0; j < y_.size(); ++j) {
      for (std::size_t i = 0; i < x_.size(); ++i) {
        double h = 3 * m.plate_roughness;
        for (Mode const& mode : drawn) h += amplitude * std::cos(mode.kx * x_[i] + mode.ky * y_[j] + mode.phase);
        raise(i, j, h);
      }
    }
  }

  void add_hemisphere(FrozenGrain const& grain, double period) {
    auto const first = std::ranges::lower_bound(x_, grain.x - grain.radius) - x_.begin();
    for (auto i = static_cast<std::size_t>(first); i < x_.size() && x_[i] < grain.x + grain.radius; ++i) {
      for (std::size_t j = 0; j < y_.size(); ++j) {
        double const dx = x_[i] - grain.x, dy = std::remainder(y_[j] - grain.y, period);
        raise(i, j, std::sqrt(std::max(0.0, grain.radius * grain.radius - dx * dx - dy * dy)));
      }
    }
  }

  TriangleSurface block(double bottom) const { return closed_block(x_, y_, z_, bottom); }

 private:
  void raise(std::size_t i, std::size_t j, double to) {
    double& z = z_[i + x_.size() * j];
    z = std::max(z, to);
  }
  std::vector<double> x_, y_, z_;
};
}  // namespace

std::vector<FrozenGrain> frozen_grains(Case const& checked) {
  MachineSettings const& m = checked.machine;
  double const wanted = m.plate_grains * m.deposition_length * m.width;
  double covered = 0;
  std::vector<FrozenGrain> grains;
  std::uint64_t draw = 0;
  for (std::int64_t id = -1; covered < wanted; --id) {  // ids of fed grains are not negative
    double const radius = draw_radius(checked, id);
    auto const meets = [&](FrozenGrain const& other, double x, double y) {
      return std::hypot(x - other.x, std::remainder(y - other.y, m.width)) < radius + other.radius;
    };
    for (int attempt = 0; attempt < 2000; ++attempt, ++draw) {
      auto const u = uniform4(checked.seed, RandomStream::plate_grains, draw);
      double const x = m.deposition_begin() + radius + u[0] * (m.deposition_length - 2 * radius), y = u[1] * m.width;
      if (std::ranges::any_of(grains, [&](FrozenGrain const& other) { return meets(other, x, y); })) continue;
      grains.push_back({x, y, radius});
      covered += pi * radius * radius;
      break;
    }
  }
  return grains;
}

TriangleSurface textured_plate(Case const& checked) {
  MachineSettings const& m = checked.machine;
  double spacing = std::numeric_limits<double>::infinity();
  if (m.plate_roughness > 0) spacing = m.plate_correlation_length / points_a_length;
  if (m.plate_grains > 0)
    spacing = std::min(spacing, std::ranges::min(fed_powder(checked).diameters) / points_a_diameter);
  Heights heights(even_points(m.deposition_begin(), m.deposition_end(), spacing), even_points(0, m.width, spacing));
  if (m.plate_roughness > 0) heights.add_roughness(checked);
  for (FrozenGrain const& grain : frozen_grains(checked)) heights.add_hemisphere(grain, m.width);
  return heights.block(-spacing);
}

}  // namespace layerloop::dem
