#pragma once
#include <string>

#include "coupling/report/report_input.hpp"

namespace layerloop::coupling {

// Each returns HTML.
std::string headline(Case const& checked, std::size_t layers);  ///< what was run, in one or two sentences
std::string cards(ReportInput const& input);          ///< the figures to look at first, with their uncertainty
std::string layer_table(ReportInput const& input);    ///< a row per quantity, a column per layer
std::string ledger_tables(ReportInput const& input);  ///< mass and particles, light and heat, with their verdicts
std::string definition_table(ReportInput const& input);
std::string case_table(Case const& checked);        ///< every key with its value in SI and its sentence
std::string effects_left_out(Case const& checked);  ///< list items: the effects that this case leaves off

}  // namespace layerloop::coupling
