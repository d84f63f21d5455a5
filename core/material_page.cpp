#include <fmt/format.h>

#include "core/case_schema.hpp"
#include "core/material_table.hpp"

namespace layerloop {
namespace {

std::string phase_word(Phase phase) { return phase == Phase::solid ? "solid" : phase == Phase::liquid ? "liquid" : ""; }

std::string evidence_word(Evidence evidence) {
  return evidence == Evidence::read ? "read" : evidence == Evidence::quoted ? "quoted" : "assumed";
}

/// "13.93 at 298, 24.96 at 1000"
std::string shown_values(PropertyTable const& table) {
  if (table.value.size() == 1) return fmt::format("{:.6g}", table.value.front());
  std::string text;
  for (std::size_t i = 0; i < table.value.size(); ++i)
    text += fmt::format("{}{:.6g} at {:g}", i == 0 ? "" : ", ", table.value[i], table.temperature[i]);
  return text;
}

std::string shown_temperatures(PropertyTable const& table) {
  if (table.temperature.size() > 1)
    return fmt::format("{:g} to {:g}", table.temperature.front(), table.temperature.back());
  return table.temperature.front() == 0 ? "" : fmt::format("{:g}", table.temperature.front());
}

std::string shown_row(PropertyRow const& row) {
  return fmt::format("| `{}` | {} | {} | {} | {} | {:g} % | {} | {} | {} |\n", row.key, phase_word(row.phase),
                     shown_values(row.values), si_unit(find_key("material", row.key)->dimension),
                     shown_temperatures(row.values), 100 * row.uncertainty, evidence_word(row.evidence), row.source,
                     row.note);
}

}  // namespace

std::string material_page() {
  std::string page =
      "# Built-in metals\n\n"
      "Written by the program from its table (`layerloop check --help-materials`); do not edit.\n"
      "Temperatures in K. A property is linear between its points and constant beyond them; a run that goes beyond "
      "says "
      "so once. Solid and liquid rows of a property join to one table, straight across the melting range.\n\n"
      "`+-`: relative uncertainty, that of the source (95 %) or half the spread of published values, whichever is "
      "larger.\n"
      "Evidence: *read*: read in the source or in an open copy of its numbers; *quoted*: as others quote the source, "
      "the print has not been compared; *assumed*: no measurement of this alloy.\n\n"
      "A case changes or adds any of it: `[material.316L]` with `conductivity = [[298, 14], [1675, 28]]` replaces that "
      "property, solid and liquid; a new name makes a new metal.\n";
  for (MetalRows const& metal : material_table()) {
    page += fmt::format(
        "\n## {}\n\nRefractive index: {}.\n\n"
        "| property | phase | value | unit | temperatures | +- | evidence | source | note |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        metal.name, metal.optical_data);
    for (PropertyRow const& row : metal.rows) page += shown_row(row);
  }
  page += "\n## Sources\n\n";
  for (auto const& [name, citation] : material_sources()) page += fmt::format("- {}: {}.\n", name, citation);
  return page;
}

}  // namespace layerloop
