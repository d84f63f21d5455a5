#include "coupling/report/csv_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/write_file.hpp"

namespace layerloop::coupling {

void CsvTable::row(std::span<double const> values) {
  for (std::size_t c = 0; c < values.size(); ++c) {
    if (c > 0) text_ += ',';
    if (std::isfinite(values[c])) fmt::format_to(std::back_inserter(text_), "{:.9g}", values[c]);
  }
  text_ += '\n';
}

void CsvTable::write(std::filesystem::path const& path) const { write_file(path, text_); }

}  // namespace layerloop::coupling
