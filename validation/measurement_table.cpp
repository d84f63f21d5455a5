// measurements.csv
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "core/spelling.hpp"
#include "core/units.hpp"
#include "validation/quantity.hpp"
#include "validation/study_tables.hpp"

namespace layerloop::validation {
namespace {

constexpr std::size_t needed_columns = 5;
std::vector<std::string> const& column_names() {
  static std::vector<std::string> const names{
      "obs_id",    "condition_id", "quantity",   "value",  "unit",   "u_stat",
      "u_sys_rel", "u_sys_abs",    "sys_group",  "rep_id", "layer",  "x",
      "y",         "operator",     "instrument", "role",   "source", "exclude_reason"};
  return names;
}

constexpr double farthest = 1;  ///< place on a plate [m]; a bare number beyond it lacks its unit

/// One row while it is read.
struct Row {
  Observation observation;
  Observable observable;
  std::string word;  ///< of a category
  Place place;       ///< of its uncertainty
};

class MeasurementReader {
 public:
  MeasurementReader(CsvTable const& table, std::vector<Condition> const& conditions, std::vector<Fault>& faults)
      : table_(table), faults_(faults) {
    for (std::size_t i = 0; i < conditions.size(); ++i) conditions_.emplace(conditions[i].id, i);
    for (std::size_t c = 0; c < table.header.size(); ++c) add_column(table.header[c], c);
    for (std::size_t c = 0; c < needed_columns && !table.header.empty(); ++c) {
      if (!columns_.contains(column_names()[c]))
        report(table.header.front(), fmt::format("missing column \"{}\" (every row needs it)", column_names()[c]));
    }
  }

  std::vector<Row> read() {
    std::vector<Row> rows;
    for (std::size_t c = 0; c < needed_columns; ++c)
      if (!columns_.contains(column_names()[c])) return rows;
    for (auto const& fields : table_.rows) {
      fields_ = &fields;
      Row row;
      check_id(row);
      row.observation.exclude_reason = text("exclude_reason");
      if (!row.observation.exclude_reason.empty()) {
        ++excluded[row.observation.exclude_reason];
        continue;
      }
      if (take(row)) rows.push_back(std::move(row));
    }
    refuse_split_conditions(rows);
    return rows;
  }

  std::map<std::string, int> excluded;  ///< rows by reason

 private:
  void report(CsvField const& field, std::string const& message) { faults_.push_back({field.place, message}); }

  void add_column(CsvField const& field, std::size_t index) {
    auto const [name, unit] = column_name(field.text);
    auto const& names = column_names();
    if (std::ranges::find(names, name) == names.end()) {
      report(field, fmt::format("unknown column \"{}\" (known: {}){}", field.text, fmt::join(names, ", "),
                                did_you_mean(name, names)));
    } else if (!columns_.emplace(name, index).second) {
      report(field, fmt::format("column \"{}\" is given twice (one value a row) leave one out", name));
    } else if (unit) {
      check_unit(field, name, *unit);
    }
  }

  void check_unit(CsvField const& field, std::string const& name, std::string const& unit) {
    bool const place = name == "x" || name == "y", share = name == "u_sys_rel";
    if (!place && !share)
      return report(field, fmt::format("column \"{}\" has a unit (each row gives its own) write it into the column "
                                       "\"unit\"",
                                       field.text));
    try {
      parse_quantity(with_unit("1", unit), place ? Dimension::length : Dimension::none);
      units_[name] = unit;
    } catch (InputError const& fault) {
      report(field, fmt::format("unit of column \"{}\": {}", name, fault.what()));
    }
  }

  /// A blank one where the file has no such column.
  CsvField field(std::string const& name) const {
    auto const column = columns_.find(name);
    return column == columns_.end() ? CsvField{"", fields_->front().place} : (*fields_)[column->second];
  }
  std::string text(std::string const& name) const { return field(name).text; }

  void check_id(Row& row) {
    CsvField const id = field("obs_id");
    row.observation.id = id.text;
    if (id.text.empty()) return report(id, "obs_id is blank (residuals are told by it) give one");
    if (auto const [at, is_new] = ids_.emplace(id.text, id.place.line); !is_new)
      report(id, fmt::format("obs_id \"{}\" is given twice (first in line {}) rename one", id.text, at->second));
  }

  bool take(Row& row) {
    std::size_t const before = faults_.size();
    Quantity const* const quantity = take_quantity(row);
    take_condition(row);
    take_place(row);
    take_role(row);
    Observation& seen = row.observation;
    seen.sys_group = text("sys_group"), seen.rep_id = text("rep_id"), seen.oper = text("operator");
    seen.instrument = text("instrument"), seen.source = text("source");
    if (quantity && quantity->is_category()) take_word(row);
    if (quantity && !quantity->is_category() && take_value(row, *quantity)) take_uncertainties(row, *quantity);
    return faults_.size() == before;
  }

  Quantity const* take_quantity(Row& row) {
    CsvField const written = field("quantity");
    row.observation.quantity = row.observable.quantity = written.text;
    Quantity const* const quantity = find_quantity(written.text);
    if (!quantity) {
      auto const names = quantity_names();
      report(written, fmt::format("unknown quantity \"{}\" (no operator takes it from the model; known: {}){}",
                                  written.text, fmt::join(names, ", "), did_you_mean(written.text, names)));
    }
    return quantity;
  }

  void take_condition(Row& row) {
    CsvField const written = field("condition_id");
    auto const condition = conditions_.find(written.text);
    if (condition != conditions_.end()) {
      row.observation.condition = row.observable.condition = condition->second;
      return;
    }
    if (conditions_.empty()) return;  // their file has faults of its own
    std::vector<std::string> ids;
    for (auto const& [id, index] : conditions_) ids.push_back(id);
    report(written, fmt::format("unknown condition \"{}\" (conditions.csv has no such condition_id){}", written.text,
                                did_you_mean(written.text, ids)));
  }

  std::optional<double> number(std::string const& name, Dimension dimension, std::string const& unit) {
    CsvField const written = field(name);
    if (written.text.empty()) return std::nullopt;
    try {
      return parse_quantity(with_unit(written.text, unit), dimension);
    } catch (InputError const& fault) {
      report(written, fmt::format("{} = {}", name, fault.what()));
      return std::nullopt;
    }
  }

  void take_place(Row& row) {
    if (auto const layer = number("layer", Dimension::none, "")) {
      if (*layer < 1 || *layer != std::floor(*layer) || *layer > 1e6) {
        report(field("layer"), fmt::format("layer = {} (must be a whole number, from 1)", text("layer")));
      } else {
        row.observable.layer = static_cast<int>(*layer);
      }
    }
    for (auto const& [name, place] : {std::pair("x", &row.observable.x), std::pair("y", &row.observable.y)}) {
      std::string const unit = units_.contains(name) ? units_.at(name) : "m";
      *place = number(name, Dimension::length, unit);
      if (*place && std::abs(**place) > farthest)
        report(field(name),
               fmt::format("{0} = {1} m (beyond any plate). Is a unit missing? Write \"{0} [mm]\"", name, text(name)));
    }
  }

  void take_role(Row& row) {
    CsvField const written = field("role");
    if (written.text == "holdout") row.observation.role = Role::holdout;
    if (written.text.empty() || written.text == "train" || written.text == "holdout") return;
    report(written, fmt::format("role = \"{}\" (must be \"train\" or \"holdout\"){}", written.text,
                                did_you_mean(written.text, {"train", "holdout"})));
  }

  void take_word(Row& row) {
    CsvField const written = field("value");
    row.word = written.text;
    auto const& words = regime_words();
    if (std::ranges::find(words, written.text) == words.end())
      report(written, fmt::format("{} = \"{}\" (must be one of {}){}", row.observation.quantity, written.text,
                                  fmt::join(words, ", "), did_you_mean(written.text, words)));
    if (!with_unit("", text("unit")).empty())
      report(field("unit"), fmt::format("{} is a word (it has no unit) leave it blank", row.observation.quantity));
  }

  bool take_value(Row& row, Quantity const& quantity) {
    CsvField const written = field("value");
    if (written.text.empty()) {
      report(written, "value is blank (nothing was measured) leave the row out, or give an exclude_reason");
      return false;
    }
    double const nothing = std::nan("");
    char const* const begin = written.text.c_str();
    char* end = nullptr;
    if (!std::isfinite(std::strtod(begin, &end)) || end == begin || *end != '\0') {
      report(written, fmt::format("value = \"{}\" is not a number{}", written.text,
                                  written.text.find(',') != std::string::npos ? " (decimals take a point)" : ""));
      return false;
    }
    try {
      row.observation.value = parse_quantity(with_unit(written.text, text("unit")), quantity.dimension);
    } catch (InputError const& fault) {
      row.observation.value = nothing;
      report(field("unit"), fmt::format("{}: {}", quantity.name, fault.what()));
      return false;
    }
    if (quantity.range.contains(row.observation.value)) return true;
    report(written, fmt::format("{} = {} (must lie in [{}, {}]). Is the unit right?", quantity.name,
                                format_quantity(row.observation.value, quantity.dimension),
                                format_quantity(quantity.range.min, quantity.dimension),
                                format_quantity(quantity.range.max, quantity.dimension)));
    return false;
  }

  double uncertainty(std::string const& name, Dimension dimension, std::string const& unit) {
    double const u = number(name, dimension, unit).value_or(0);
    if (u < 0)
      report(field(name), fmt::format("{} = {} (must be at least 0) it is one standard deviation", name, text(name)));
    return u;
  }

  void take_uncertainties(Row& row, Quantity const& quantity) {
    Observation& seen = row.observation;
    seen.u_stat = uncertainty("u_stat", quantity.dimension, text("unit"));
    seen.u_sys_abs = uncertainty("u_sys_abs", quantity.dimension, text("unit"));
    seen.u_sys_rel =
        uncertainty("u_sys_rel", Dimension::none, units_.contains("u_sys_rel") ? units_.at("u_sys_rel") : "");
    if (seen.u_sys_rel > 1)
      report(field("u_sys_rel"),
             fmt::format("u_sys_rel = {} (must be a share of the value, at most 1). Is it in %?", text("u_sys_rel")));
    row.place = field(columns_.contains("u_stat") ? "u_stat" : "value").place;
  }

  void refuse_split_conditions(std::vector<Row> const& rows) {
    if (conditions_.empty()) return;
    std::map<std::size_t, std::pair<Role, std::uint32_t>> roles;
    for (Row const& row : rows) {
      Observation const& seen = row.observation;
      std::uint32_t const line = ids_.at(seen.id);
      auto const [at, is_new] = roles.emplace(seen.condition, std::pair(seen.role, line));
      if (is_new || at->second.first == seen.role) continue;
      std::string id;
      for (auto const& [name, index] : conditions_)
        if (index == seen.condition) id = name;
      faults_.push_back({{line, 1, {}},
                         fmt::format("condition \"{}\" has rows of both roles (the other in line {}; what is held out "
                                     "must be whole conditions) give all its rows one role",
                                     id, at->second.second)});
      at->second.first = seen.role;  // once for each change
    }
  }

  CsvTable const& table_;
  std::vector<Fault>& faults_;
  std::map<std::string, std::size_t> columns_, conditions_;
  std::map<std::string, std::string> units_;  ///< of x, y, u_sys_rel
  std::map<std::string, std::uint32_t> ids_;
  std::vector<CsvField> const* fields_ = nullptr;
};

bool has_own_scatter(Observation const& seen) {
  return seen.u_stat > 0 || (seen.sys_group.empty() && (seen.u_sys_rel > 0 || seen.u_sys_abs > 0));
}

/// Relative standard deviation of a quantity's replicates, pooled over the conditions.
struct Scatter {
  double squares = 0;
  int dof = 0;
  double relative() const { return std::sqrt(squares / dof); }
};

std::map<std::string, Scatter> scatter_of_replicates(std::vector<Row> const& rows) {
  std::map<Observable, std::vector<double>> groups;
  for (Row const& row : rows)
    if (row.word.empty()) groups[row.observable].push_back(row.observation.value);
  std::map<std::string, Scatter> all;
  for (auto const& [observable, values] : groups) {
    double mean = 0;
    for (double const value : values) mean += value / static_cast<double>(values.size());
    if (values.size() < 2 || mean == 0) continue;
    Scatter& scatter = all[observable.quantity];
    for (double const value : values) scatter.squares += std::pow(value / mean - 1, 2);
    scatter.dof += static_cast<int>(values.size()) - 1;
  }
  return all;
}

/// Readings without a scatter of their own take that of their replicates.
void complete_uncertainties(std::vector<Row>& rows, Study& study, std::vector<Fault>& faults) {
  std::map<std::string, Scatter> const scatter = scatter_of_replicates(rows);
  std::map<std::string, int> completed;
  for (Row& row : rows) {
    Observation& seen = row.observation;
    if (!row.word.empty() || has_own_scatter(seen)) continue;
    auto const replicates = scatter.find(seen.quantity);
    if (replicates == scatter.end() || replicates->second.squares == 0) {
      faults.push_back({row.place, fmt::format("\"{}\" has no uncertainty (u_stat is blank or 0, and {} has no "
                                               "replicates to tell it from) give u_stat, one standard deviation",
                                               seen.id, seen.quantity)});
      continue;
    }
    seen.u_stat = replicates->second.relative() * std::abs(seen.value);
    ++completed[seen.quantity];
  }
  for (auto const& [quantity, count] : completed)
    study.limits.push_back(fmt::format(
        "{} readings of {} give no u_stat: {:.2g} % is taken, the scatter of its replicates ({} degrees of freedom)",
        count, quantity, 100 * scatter.at(quantity).relative(), scatter.at(quantity).dof));
}

std::size_t index_of(Observable const& observable, std::vector<Observable>& all) {
  auto const found = std::ranges::find(all, observable);
  if (found == all.end()) all.push_back(observable);
  return static_cast<std::size_t>(std::ranges::find(all, observable) - all.begin());
}

}  // namespace

void read_measurements(CsvTable const& table, Role which, Study& study, std::vector<Fault>& faults) {
  MeasurementReader reader(table, study.conditions, faults);
  std::vector<Row> rows = reader.read();
  bool const any = !rows.empty();
  std::erase_if(rows, [&](Row const& row) { return row.observation.role != which; });
  for (auto const& [reason, count] : reader.excluded)
    study.limits.push_back(fmt::format("{} row{} left out: {}", count, count == 1 ? "" : "s", reason));
  complete_uncertainties(rows, study, faults);
  for (Row& row : rows) {
    if (!row.word.empty()) continue;
    row.observation.observable = index_of(row.observable, study.observables);
    study.observations.push_back(row.observation);
  }
  for (Row const& row : rows) {
    if (!row.word.empty())
      study.categories.push_back({row.observation.id, index_of(row.observable, study.observables), row.word});
  }
  if (!study.observations.empty() || !faults.empty()) return;
  std::string const role = which == Role::train ? "train" : "holdout";
  faults.push_back({{},
                    any ? fmt::format("no row of role \"{}\" holds a number (there is nothing to {})", role,
                                      which == Role::train ? "learn from" : "confirm with")
                        : "no measurements (there is nothing to compare with)"});
}

}  // namespace layerloop::validation
