#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/case_key.hpp"
#include "validation/csv_table.hpp"
#include "validation/study.hpp"

// What read_study is made of. Every function adds what it finds wrong to `faults` and goes on.
namespace layerloop::validation {

/// A column's name and the unit in brackets behind it: "u(laser.power) [W]".
struct ColumnName {
  std::string name;
  std::optional<std::string> unit;
};
ColumnName column_name(std::string const& header);

/// Number and unit as one text for parse_quantity; "-" and "1" stand for no unit.
/// \throws InputError where the number has a unit as well ("0.057 m" and "m" must not become millimetres)
std::string with_unit(std::string const& number, std::string const& unit);

/// A difference between two values, so that degC counts as K. \throws InputError
double parse_difference(std::string const& number, std::string const& unit, Dimension dimension);

std::vector<std::string> const& label_names();

std::vector<Condition> read_conditions(CsvTable const& table, std::vector<Fault>& faults);

/// The rows of one role, into `study`, whose conditions are known; says in its limits what was left out.
void read_measurements(CsvTable const& table, Role which, Study& study, std::vector<Fault>& faults);

/// The [[calibration]] tables, and one relative error for each input that is uncertain.
std::vector<CalibrationParameter> read_calibration(std::vector<TomlTable> const& tables,
                                                   std::vector<Condition> const& conditions,
                                                   std::vector<Fault>& faults);

/// What can be judged only in part.
std::vector<std::string> limits_of(Study const& study, bool has_holdout);

}  // namespace layerloop::validation
