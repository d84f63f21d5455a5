#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/material.hpp"

namespace layerloop {

enum class Phase { any, solid, liquid };

/// How far a value can be trusted beyond its uncertainty.
enum class Evidence {
  read,    ///< read in the source, or in an open copy of its numbers
  quoted,  ///< as others quote the source; the print has not been compared
  assumed  ///< no measurement of this alloy: a relative's value, or a usual one
};

/// One property of one metal in one phase. Solid and liquid rows of a key join to one table.
struct PropertyRow {
  std::string key;       ///< of [material.NAME]
  Phase phase;           ///< that the values hold in
  PropertyTable values;  ///< SI; first to last temperature is the range; one point at 0 K: no temperature belongs to it
  double uncertainty;    ///< relative: that of the source (95 %), or half the spread of published values if larger
  Evidence evidence;
  std::string source;  ///< names in `material_sources`, joined by ", "
  std::string note;    ///< why this value where others exist; may be empty
};

struct MetalRows {
  std::string name, optical_data;
  std::vector<PropertyRow> rows;
};

/// All that is known of the built-in metals (core/material_table.cpp).
std::vector<MetalRows> const& material_table();

/// Name -> citation.
std::vector<std::pair<std::string, std::string>> const& material_sources();

/// The parts of PropertyRow::source.
std::vector<std::string> source_names(PropertyRow const& row);

/// Markdown page of the table (docs/materials.md, `check --help-materials`).
std::string material_page();

}  // namespace layerloop
