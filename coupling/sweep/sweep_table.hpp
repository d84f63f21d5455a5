#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/statistics.hpp"
#include "coupling/report/shown_quantity.hpp"
#include "coupling/sweep/sweep_plan.hpp"

namespace layerloop::coupling {

/// The figures of a sweep that people look at, in the units of their quantities.
struct SweepTable {
  std::vector<ShownQuantity> quantities;    ///< that at least one case gives
  std::vector<std::vector<double>> values;  ///< (cases, quantities); not a number: nothing there
  std::vector<std::vector<Sample>> points;  ///< (points, quantities), over the seeds
};

/// \param summaries  of every case; null where there is none
SweepTable tabulate(SweepPlan const& plan, std::vector<nlohmann::json> const& summaries);

/// Whether the quantity differs between points.
bool varies(SweepTable const& table, std::size_t quantity);

/// A swept number in the unit that people use: "um", 1e6.
struct ShownUnit {
  std::string name;
  double scale;
};
ShownUnit shown_unit(Dimension dimension);

}  // namespace layerloop::coupling
