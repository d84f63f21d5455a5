#include "coupling/report/shown_quantity.hpp"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/json_number.hpp"

namespace layerloop::coupling {
namespace {

constexpr char const *um = "\xc2\xb5m", *ug = "\xc2\xb5g";

}  // namespace

std::vector<ShownQuantity> layer_quantities() {
  return {{"effective_thickness", "effective thickness", um, 1e6},
          {"real_effective_thickness", "real effective thickness", um, 1e6},
          {"void_layer", "void layer", um, 1e6},
          {"volume_fraction_nominal", "volume fraction, nominal", ""},
          {"volume_fraction_real", "volume fraction, real", ""},
          {"surface_coverage", "surface coverage", ""},
          {"roughness_sa", "roughness Sa", um, 1e6},
          {"roughness_sq", "roughness Sq", um, 1e6},
          {"roughness_sz", "roughness Sz", um, 1e6},
          {"d10", "D10 by volume", um, 1e6},
          {"d50", "D50 by volume", um, 1e6},
          {"d90", "D90 by volume", um, 1e6},
          {"d10_number", "D10 by number", um, 1e6},
          {"d50_number", "D50 by number", um, 1e6},
          {"d90_number", "D90 by number", um, 1e6},
          {"mean_diameter", "mean diameter by number", um, 1e6},
          {"sauter_diameter", "Sauter diameter D[3,2]", um, 1e6},
          {"mass_diameter", "diameter D[4,3]", um, 1e6},
          {"coordination_number", "coordination number", ""},
          {"rattler_fraction", "share of rattlers", ""},
          {"segregation_index", "segregation index", ""},
          {"lacey_index", "Lacey index", ""},
          {"heap_angle_accumulation", "heap angle, accumulation", "deg"},
          {"heap_angle_deposition", "heap angle, deposition", "deg"},
          {"settled_height", "settled height of the feed", um, 1e6},
          {"settled_density", "settled density of the feed", ""},
          {"reservoir_mean_diameter", "mean diameter left in the reservoir", um, 1e6},
          {"reservoir_mass_ratio", "mass left in the reservoir over before", ""},
          {"blade_force", "largest force on the blade", "mN", 1e3},
          {"absorptivity", "absorptivity", ""},
          {"melted_mass", "melted mass", ug, 1e9},
          {"part_relative_density", "relative density of the part", ""}};
}

std::vector<ShownQuantity> exposure_quantities() {
  return {{"absorptivity", "absorptivity", ""},
          {"mean_bounces", "hits of a ray", ""},
          {"pool.width", "width of the pool", um, 1e6},
          {"pool.depth", "depth of the pool", um, 1e6},
          {"pool.length", "length of the pool", um, 1e6},
          {"pool.depth_from_top", "depth of the pool from the top", um, 1e6},
          {"pool.bead_height", "height of the bead", um, 1e6},
          {"depression_depth", "depth of the vapour depression", um, 1e6},
          {"peak_temperature", "peak temperature", "K"},
          {"cooling_rate", "cooling rate", "K/us", 1e-6},
          {"fusion.unmelted_powder", "powder left unmelted", ""},
          {"fusion.overlap_depth", "depth of the pool where tracks meet", um, 1e6},
          {"angle_of_repose", "angle of repose", "deg"},
          {"slipping_angle", "slipping angle", "deg"}};
}

std::string title_of(ShownQuantity const& q) {
  return q.unit.empty() ? q.label : fmt::format("{} [{}]", q.label, q.unit);
}

std::string column_unit(ShownQuantity const& q) {
  std::string const ascii = q.unit == um ? "um" : q.unit == ug ? "ug" : q.unit;
  return ascii.empty() ? "" : fmt::format(" [{}]", ascii);
}

double figure_in(nlohmann::json const& from, std::string const& key) {
  nlohmann::json const* at = &from;
  for (std::size_t start = 0; start <= key.size();) {
    std::size_t const dot = std::min(key.find('.', start), key.size());
    auto const found = at->find(key.substr(start, dot - start));
    if (!at->is_object() || found == at->end()) return std::numeric_limits<double>::quiet_NaN();
    at = &*found;
    start = dot + 1;
  }
  return number_or_nan(*at);
}

}  // namespace layerloop::coupling
