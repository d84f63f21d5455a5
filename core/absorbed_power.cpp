#include "core/absorbed_power.hpp"

#include <cmath>

namespace layerloop {

void accumulate(AbsorbedPower& sum, AbsorbedPower const& other, double weight) {
  std::vector<std::int64_t> cell;
  std::vector<double> watts;
  cell.reserve(sum.cell.size() + other.cell.size());
  watts.reserve(cell.capacity());
  std::size_t a = 0, b = 0;
  while (a < sum.cell.size() || b < other.cell.size()) {
    bool const take_a = b == other.cell.size() || (a < sum.cell.size() && sum.cell[a] <= other.cell[b]);
    bool const take_b = a == sum.cell.size() || (b < other.cell.size() && other.cell[b] <= sum.cell[a]);
    cell.push_back(take_a ? sum.cell[a] : other.cell[b]);
    watts.push_back((take_a ? sum.watts[a] : 0.0) + (take_b ? weight * other.watts[b] : 0.0));
    a += take_a;
    b += take_b;
  }
  sum.cell = std::move(cell);
  sum.watts = std::move(watts);

  // Variances of independent traces add; the mean over positions weighs each by its incident power.
  double const incident = sum.incident + weight * other.incident;
  double const error_watts =
      std::hypot(sum.standard_error * sum.incident, weight * other.standard_error * other.incident);
  double const hits =
      sum.mean_bounces * static_cast<double>(sum.rays) + other.mean_bounces * static_cast<double>(other.rays);
  sum.incident = incident;
  sum.absorbed += weight * other.absorbed;
  sum.escaped += weight * other.escaped;
  sum.attenuated += weight * other.attenuated;
  sum.residual += weight * other.residual;
  sum.outside_grid += weight * other.outside_grid;
  sum.rays += other.rays;
  sum.mean_bounces = sum.rays > 0 ? hits / static_cast<double>(sum.rays) : 0.0;
  sum.absorptivity = incident > 0 ? sum.absorbed / incident : 0.0;
  sum.standard_error = incident > 0 ? error_watts / incident : 0.0;
}

double ray_energy_error(AbsorbedPower const& power) {
  return std::abs(power.incident - power.absorbed - power.escaped - power.attenuated - power.residual) / power.incident;
}

}  // namespace layerloop
