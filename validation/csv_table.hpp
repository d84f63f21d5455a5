#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/toml_entries.hpp"

namespace layerloop::validation {

/// What stands between two commas, without blanks and quotation marks around it.
struct CsvField {
  std::string text;
  Place place;
};

/// Rows are as long as the header.
struct CsvTable {
  std::vector<CsvField> header;
  std::vector<std::vector<CsvField>> rows;
};

/// Comma-separated values as RFC 4180 has them; empty lines and lines that begin with # are left out, a byte order mark
/// and a micro sign are understood. Rows of another length than the header are faults and left out; the table is empty
/// when the fields are apart by something else.
CsvTable parse_csv(std::string_view text, std::vector<Fault>& faults);

}  // namespace layerloop::validation
