#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

namespace layerloop::coupling {

/// One summary over those of runs that differ in their seed only: every number X becomes the mean, beside it X_u_bed
/// (half width of its 95 % t-interval) and X_n (runs in which there was something to measure); places (x, layer) stay,
/// X_u_num is averaged. Ledger: masses, particles and heat add up, relative errors are the worst, powers are means;
/// wall times add up. \pre at least one, all with the same layers and bins
nlohmann::json summary_over_replicates(std::vector<nlohmann::json> const& summaries);

}  // namespace layerloop::coupling
