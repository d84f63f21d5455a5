#pragma once
#include <string>

#include "validation/explanation.hpp"

namespace layerloop::validation {

// Each returns a section's content as HTML; empty where there is nothing to show.
std::string parity_figures(Explanation const& explained);
std::string parity_figures(Study const& study, ObservationTable const& table, bool effects, std::string const& csv);
std::string residual_maps(Explanation const& explained);
std::string stage_strip(Explanation const& explained);
std::string evidence_bars(Explanation const& explained);
std::string signature_overlays(Explanation const& explained);
std::string confusion_matrix(Explanation const& explained);
std::string pull_bars(Explanation const& explained);
std::string waterfall_bars(Explanation const& explained);
std::string next_table(Explanation const& explained);

}  // namespace layerloop::validation
