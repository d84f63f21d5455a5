#include "coupling/sweep/sweep_table.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace layerloop::coupling {
namespace {

using nlohmann::json;

/// Of a layer loop the last layer: what the build has come to.
json const& figures_of(json const& summary) {
  auto const layers = summary.find("layers");
  return summary.is_object() && layers != summary.end() && !layers->empty() ? layers->back() : summary;
}

std::vector<ShownQuantity> all_quantities() {
  std::vector<ShownQuantity> all = layer_quantities();
  for (ShownQuantity const& quantity : exposure_quantities()) {
    if (std::ranges::find(all, quantity.key, &ShownQuantity::key) == all.end()) all.push_back(quantity);
  }
  return all;
}

}  // namespace

SweepTable tabulate(SweepPlan const& plan, std::vector<json> const& summaries) {
  SweepTable table;
  for (ShownQuantity const& quantity : all_quantities()) {
    auto const gives = [&](json const& one) { return std::isfinite(figure_in(figures_of(one), quantity.key)); };
    if (std::ranges::any_of(summaries, gives)) table.quantities.push_back(quantity);
  }
  for (json const& summary : summaries) {
    std::vector<double>& row = table.values.emplace_back();
    for (ShownQuantity const& q : table.quantities) row.push_back(q.scale * figure_in(figures_of(summary), q.key));
  }
  table.points.resize(plan.points);
  for (std::size_t q = 0; q < table.quantities.size(); ++q) {
    std::vector<std::vector<double>> seeds(plan.points);
    for (std::size_t k = 0; k < plan.cases.size(); ++k) seeds[plan.cases[k].point].push_back(table.values[k][q]);
    for (std::size_t p = 0; p < plan.points; ++p) table.points[p].push_back(sample_of(seeds[p]));
  }
  return table;
}

bool varies(SweepTable const& table, std::size_t quantity) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::vector<Sample> const& point : table.points) {
    if (!std::isfinite(point[quantity].mean)) continue;
    least = std::min(least, point[quantity].mean);
    most = std::max(most, point[quantity].mean);
  }
  return most - least > 1e-9 * std::max(std::abs(most), std::abs(least));
}

ShownUnit shown_unit(Dimension dimension) {
  if (dimension == Dimension::length) return {"um", 1e6};
  if (dimension == Dimension::speed) return {"mm/s", 1e3};
  if (dimension == Dimension::angle) return {"deg", 180 / std::numbers::pi};
  return {std::string(si_unit(dimension)), 1};
}

}  // namespace layerloop::coupling
