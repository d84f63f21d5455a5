#include <algorithm>
#include <array>

#include "core/bed_text.hpp"

namespace layerloop {
namespace {
constexpr std::array<std::string_view, 5> columns{"x", "y", "z", "radius", "material"};

/// A line that names columns: "x,y,z,radius", with or without "#".
bool names_columns(std::string_view line) {
  std::vector<std::string_view> const words = words_of(line, ',');
  return std::ranges::find(words, "radius") != words.end() || std::ranges::find(words, "x") != words.end();
}

double unit_of(BedText const& text, std::string_view name) {
  if (name == "m") return 1;
  if (name == "mm") return 1e-3;
  if (name == "um") return 1e-6;
  text.refuse("units={} is not known (m, mm and um are) give one of these", name);
}

struct CsvHeader {
  double unit = 1;
  std::array<std::ptrdiff_t, 5> at{0, 1, 2, 3, -1};  ///< place of each of `columns`; -1: not there
  std::size_t width = 4;                             ///< columns of a row
  bool fixed = false;                                ///< by a line of the file

  void read_columns(BedText const& text, std::string_view line) {
    std::vector<std::string_view> const words = words_of(line, ',');
    for (std::string_view const word : words) {
      if (std::ranges::find(columns, word) == columns.end())
        text.refuse("column \"{}\" is not known (x,y,z,radius and material are) remove or rename it", word);
    }
    for (std::size_t c = 0; c < columns.size(); ++c) {
      auto const found = std::ranges::find(words, columns[c]);
      at[c] = found == words.end() ? -1 : found - words.begin();
      if (at[c] < 0 && c < 4) text.refuse("column \"{}\" is missing (x,y,z,radius are needed) add it", columns[c]);
    }
    width = words.size();
    fixed = true;
  }
};

void read_keys(BedText const& text, std::string_view line, BedFile& file, CsvHeader& header) {
  if (auto const units = value_of(line, "units")) header.unit = unit_of(text, *units);
  auto const read = [&](std::string_view key, std::optional<double>& into, double unit) {
    if (auto const word = value_of(line, key)) into = unit * text.number(*word, key);
  };
  read("periodic_x", file.periodic_x, header.unit);
  read("periodic_y", file.periodic_y, header.unit);
  read("floor_z", file.floor_z, header.unit);
  read("density", file.density, 1);
}
}  // namespace

BedFile read_bed_csv(BedText text) {
  BedFile file;
  CsvHeader header;
  std::vector<GrainRow> rows;
  while (auto const read = text.next()) {
    std::string_view line = *read;
    if (line.empty()) continue;
    if (line.starts_with('#')) {
      line.remove_prefix(1);
      if (rows.empty() && names_columns(line)) header.read_columns(text, line);
      if (rows.empty()) read_keys(text, line, file, header);
      continue;
    }
    if (rows.empty() && names_columns(line)) {
      header.read_columns(text, line);
      continue;
    }
    std::vector<std::string_view> const words = words_of(line, ',');
    if (!header.fixed && words.size() == 5) header = {header.unit, {0, 1, 2, 3, 4}, 5, true};
    if (words.size() != header.width)
      text.refuse("{} values in a row (there must be {}) write x,y,z,radius[,material]", words.size(), header.width);
    auto const value = [&](std::size_t c) {
      return text.number(words[static_cast<std::size_t>(header.at[c])], columns[c]);
    };
    GrainRow row;
    row.id = static_cast<std::int64_t>(rows.size());
    row.position = header.unit * Vec3(value(0), value(1), value(2));
    row.radius = header.unit * value(3);
    if (header.at[4] >= 0)
      row.material =
          static_cast<std::int32_t>(text.whole_number(words[static_cast<std::size_t>(header.at[4])], "material"));
    row.line = text.line();
    check_row(text, row);
    rows.push_back(row);
  }
  file.bed = bed_of(text, std::move(rows));
  return file;
}

std::string bed_as_csv(BedFile const& file) {
  std::string text = "#";
  auto const key = [&](std::string_view name, std::optional<double> value) {
    if (value) text += fmt::format(" {}={:.17g}", name, *value);
  };
  key("periodic_x", file.periodic_x);
  key("periodic_y", file.periodic_y);
  key("floor_z", file.floor_z);
  text += " units=m";
  key("density", file.density);
  text += "\n# x,y,z,radius,material\n";
  PowderBed const& bed = file.bed;
  for (std::size_t i = 0; i < bed.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{:.17g},{:.17g},{:.17g},{:.17g},{}\n", bed.x[i], bed.y[i], bed.z[i],
                   bed.radius[i], bed.material[i]);
  return text;
}

}  // namespace layerloop
