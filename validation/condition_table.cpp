// conditions.csv
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "core/case_values.hpp"
#include "core/error.hpp"
#include "core/spelling.hpp"
#include "validation/study_tables.hpp"

namespace layerloop::validation {
namespace {

enum class ColumnKind { id, label, input, word, uncertainty, none };

struct Column {
  ColumnKind kind = ColumnKind::none;
  std::string name;  ///< the label's, or the key's
  std::string unit;
  CaseKey const* key = nullptr;
};

class ConditionReader {
 public:
  ConditionReader(CsvTable const& table, std::vector<Fault>& faults) : table_(table), faults_(faults) {
    for (CsvField const& field : table.header) columns_.push_back(column_of(field));
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (columns_[c].kind != ColumnKind::uncertainty || has(ColumnKind::input, columns_[c].name)) continue;
      report(table.header[c], fmt::format("\"{}\" has no column \"{}\" beside it (an uncertainty of what?)",
                                          table.header[c].text, columns_[c].name));
    }
    if (!table.header.empty() && !has(ColumnKind::id, "condition_id"))
      report(table.header.front(), "missing column \"condition_id\" (measurements name their condition by it)");
  }

  std::vector<Condition> read() {
    std::vector<Condition> conditions;
    std::map<std::string, std::uint32_t> seen;
    for (auto const& row : table_.rows) {
      Condition condition;
      for (std::size_t c = 0; c < columns_.size(); ++c) take(columns_[c], row[c], condition);
      if (condition.id.empty()) continue;
      std::uint32_t const line = row.front().place.line;
      if (auto const [at, is_new] = seen.emplace(condition.id, line); !is_new) {
        report(row.front(), fmt::format("condition_id \"{}\" is given twice (first in line {}) rename one",
                                        condition.id, at->second));
      } else {
        conditions.push_back(std::move(condition));
      }
    }
    if (table_.rows.empty() && !table_.header.empty())
      report(table_.header.front(), "no conditions (there is nothing to compute) add a row");
    return conditions;
  }

 private:
  void report(CsvField const& field, std::string const& message) { faults_.push_back({field.place, message}); }

  bool has(ColumnKind kind, std::string const& name) const {
    return std::ranges::any_of(columns_, [&](Column const& c) { return c.kind == kind && c.name == name; });
  }

  Column column_of(CsvField const& field) {
    auto const [name, unit] = column_name(field.text);
    bool const is_label = std::ranges::find(label_names(), name) != label_names().end();
    Column column{ColumnKind::none, name, unit.value_or(""), nullptr};
    if (name == "condition_id" || is_label) {
      column.kind = is_label ? ColumnKind::label : ColumnKind::id;
    } else {
      bool const uncertainty = name.starts_with("u(") && name.ends_with(")");
      if (uncertainty) column.name = name.substr(2, name.size() - 3);
      column.key = case_key(column.name);
      if (column.key) {
        column.kind = kind_of(field, column, unit, uncertainty);
      } else {
        report_unknown(field, column.name);
      }
    }
    if (column.kind != ColumnKind::none && has(column.kind, column.name)) {
      report(field, fmt::format("column \"{}\" is given twice (one value a condition) leave one out", field.text));
      column.kind = ColumnKind::none;
    }
    return column;
  }

  /// Of a column that belongs to a key; none when its unit is wrong.
  ColumnKind kind_of(CsvField const& field, Column const& column, std::optional<std::string> const& unit,
                     bool uncertainty) {
    bool const number = takes_number(*column.key);
    if (uncertainty && !number) {
      report(field, fmt::format("\"{}\" is not a number (only numbers have an uncertainty)", column.name));
      return ColumnKind::none;
    }
    if (!number) return ColumnKind::word;
    std::string const si(si_unit(column.key->dimension));
    if (!unit && !si.empty()) {
      report(field, fmt::format("column \"{}\" has no unit (its numbers could mean anything) write it in brackets: "
                                "\"{} [{}]\"",
                                field.text, field.text, si));
      return ColumnKind::none;
    }
    try {
      parse_quantity(with_unit("1", column.unit), column.key->dimension);
    } catch (InputError const& fault) {
      report(field, fmt::format("unit of column \"{}\": {}", column.name, fault.what()));
      return ColumnKind::none;
    }
    return uncertainty ? ColumnKind::uncertainty : ColumnKind::input;
  }

  void report_unknown(CsvField const& field, std::string const& name) {
    std::vector<std::string> others = label_names();
    others.push_back("condition_id");
    report(field, fmt::format("unknown column \"{}\" (columns are condition_id, the labels {}, keys of the case file "
                              "with their unit, such as \"laser.power [W]\", and their uncertainties, such as "
                              "\"u(laser.power) [W]\"){}",
                              field.text, fmt::join(label_names(), ", "), likely_case_key(name, others)));
  }

  void take(Column const& column, CsvField const& field, Condition& condition) {
    if (field.text.empty()) {
      if (column.kind == ColumnKind::id) report(field, "condition_id is blank (measurements name it) give one");
      return;
    }
    try {
      if (column.kind == ColumnKind::id) condition.id = field.text;
      if (column.kind == ColumnKind::label) condition.labels[column.name] = field.text;
      if (column.kind == ColumnKind::input) condition.inputs[column.name] = input(column, field.text);
      if (column.kind == ColumnKind::word) condition.words[column.name] = word(column, field.text);
      if (column.kind == ColumnKind::uncertainty) take_uncertainty(column, field, condition);
    } catch (InputError const& fault) {
      report(field, fault.what());
    } catch (SyntaxFault const& syntax) {
      report(field, fmt::format("{} = {} ({})", column.name, field.text, syntax.fault.message));
    }
  }

  double input(Column const& column, std::string const& text) const {
    std::string const quantity = with_unit(text, column.unit);
    Case scratch;
    store(*column.key, {quantity}, scratch);  // whole number? in its range?
    return parse_quantity(quantity, column.key->dimension);
  }

  std::string word(Column const& column, std::string const& text) const {
    bool const is_text = std::holds_alternative<Choice>(column.key->target) ||
                         std::holds_alternative<Member<std::string>>(column.key->target);
    Case scratch;
    store(*column.key, is_text ? TomlValue{text} : parse_value(text), scratch);
    return text;
  }

  void take_uncertainty(Column const& column, CsvField const& field, Condition& condition) {
    double const u = parse_difference(field.text, column.unit, column.key->dimension);
    if (u < 0) {
      report(field,
             fmt::format("u({}) = {} (must be at least 0) it is one standard deviation", column.name, field.text));
    } else if (u > 0) {
      condition.u_inputs[column.name] = u;
    }
  }

  CsvTable const& table_;
  std::vector<Fault>& faults_;
  std::vector<Column> columns_;
};

}  // namespace

ColumnName column_name(std::string const& header) {
  std::size_t const open = header.find('[');
  if (open == std::string::npos || !header.ends_with(']')) return {header, std::nullopt};
  std::size_t const end = header.find_last_not_of(' ', open == 0 ? 0 : open - 1);
  return {header.substr(0, open == 0 ? 0 : end + 1), header.substr(open + 1, header.size() - open - 2)};
}

std::string with_unit(std::string const& number, std::string const& unit) {
  if (unit.empty() || unit == "-" || unit == "1") return number;
  double value = 0;
  char const* const last = number.data() + number.size();
  auto const [end, fault] = std::from_chars(number.data(), last, value);
  char const* const rest = std::find_if(end, last, [](char c) { return c != ' '; });
  if (fault == std::errc{} && rest != last && *rest != ',')
    throw InputError(
        fmt::format("\"{}\" has a unit of its own (the column gives {}) write the number alone", number, unit));
  return number + " " + unit;
}

double parse_difference(std::string const& number, std::string const& unit, Dimension dimension) {
  return parse_quantity(with_unit(number, unit), dimension) - parse_quantity(with_unit("0", unit), dimension);
}

std::vector<std::string> const& label_names() {
  static std::vector<std::string> const names{"machine", "build", "lot", "plate"};
  return names;
}

std::vector<Condition> read_conditions(CsvTable const& table, std::vector<Fault>& faults) {
  return ConditionReader(table, faults).read();
}

}  // namespace layerloop::validation
