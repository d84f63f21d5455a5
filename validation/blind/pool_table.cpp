#include "validation/blind/pool_table.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "thermal/eagar_tsai.hpp"

namespace layerloop::validation {
namespace {

constexpr std::size_t speeds = 28, excesses = 48;
constexpr double first_speed = -1.0, last_speed = 4.6;  // ln of the dimensionless speed
constexpr double last_excess = 6.5;                     // ln of the power over that which just melts

/// Hottest temperature that a place beside or below the track ever has, at unit power.
double peak(double speed, double side, double down) {
  thermal::MovingBeam const beam{.absorbed_power = 1, .speed = speed, .spot_radius = 1, .ambient_temperature = 0};
  thermal::ConstantMetal const metal{.conductivity = 1, .heat_capacity = 1, .melting_point = 1};
  double const reach = side * side + down * down;
  auto const colder = [&](double x) { return -thermal::eagar_tsai_temperature(beam, metal, {x, side, down}); };
  // Under the beam and far behind it there may be a maximum each.
  double const behind = -2 - speed * reach, split = -0.4 - 0.15 * speed * reach;
  using boost::math::tools::brent_find_minima;
  return -std::min(brent_find_minima(colder, behind, split, 16).second,
                   brent_find_minima(colder, split, 1.0, 16).second);
}

using Row = std::array<double, excesses>;

struct Table {
  std::array<double, speeds> peaks;           ///< ln of the peak temperature on the track
  std::array<Row, speeds> half_width, depth;  ///< ln(extent^2 / excess): regular down to where nothing melts
};

/// ln(extent^2 / excess) at equal steps of the excess, from peaks at growing distances.
Row extents(double speed, double on_track, bool down) {
  std::vector<double> excess, value;
  for (double s = 0.03; excess.empty() || excess.back() < last_excess; s *= 1.08) {
    excess.push_back(on_track - std::log(down ? peak(speed, 0, s) : peak(speed, s, 0)));
    value.push_back(std::log(s * s / excess.back()));
  }
  Row row;
  for (std::size_t i = 0; i < excesses; ++i) {
    double const wanted = last_excess * static_cast<double>(i) / (excesses - 1);
    auto const above = std::clamp<std::ptrdiff_t>(std::ranges::lower_bound(excess, wanted) - excess.begin(), 1,
                                                  std::ssize(excess) - 1);
    auto const b = static_cast<std::size_t>(above), a = b - 1;
    row[i] = value[a] + (value[b] - value[a]) * (wanted - excess[a]) / (excess[b] - excess[a]);
  }
  return row;
}

Table make_table() {
  Table table;
  for (std::size_t i = 0; i < speeds; ++i) {
    double const speed = std::exp(first_speed + (last_speed - first_speed) * static_cast<double>(i) / (speeds - 1));
    table.peaks[i] = std::log(peak(speed, 0, 0));
    table.half_width[i] = extents(speed, table.peaks[i], false);
    table.depth[i] = extents(speed, table.peaks[i], true);
  }
  return table;
}

/// Weights of four neighbours: cubic convolution (Keys, IEEE Trans. ASSP 29 (1981) 1153), once differentiable.
struct Stencil {
  std::size_t first;
  std::array<double, 4> weights;
};

Stencil stencil(double place, std::size_t count) {
  double const cell = std::clamp(std::floor(place), 1.0, static_cast<double>(count) - 3);
  double const u = place - cell;
  return {static_cast<std::size_t>(cell) - 1,
          {0.5 * u * (-1 + u * (2 - u)), 1 + u * u * (-2.5 + 1.5 * u), 0.5 * u * (1 + u * (4 - 3 * u)),
           0.5 * u * u * (u - 1)}};
}

double interpolate(std::array<Row, speeds> const& rows, Stencil const& speed, Stencil const& excess) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      sum += speed.weights[i] * excess.weights[j] * rows[speed.first + i][excess.first + j];
  return sum;
}

}  // namespace

DimensionlessPool dimensionless_pool(double power, double speed) {
  static Table const table = make_table();
  Stencil const of_speed = stencil((std::log(speed) - first_speed) / (last_speed - first_speed) * (speeds - 1), speeds);
  double excess = std::log(power);
  for (std::size_t i = 0; i < 4; ++i) excess += of_speed.weights[i] * table.peaks[of_speed.first + i];
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!(excess > 0)) return {none, none};
  Stencil const of_excess = stencil(excess / last_excess * (excesses - 1), excesses);
  auto const extent = [&](std::array<Row, speeds> const& rows) {
    return std::sqrt(excess * std::exp(interpolate(rows, of_speed, of_excess)));
  };
  return {extent(table.half_width), extent(table.depth)};
}

}  // namespace layerloop::validation
