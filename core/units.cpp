#include "core/units.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/spelling.hpp"

namespace layerloop {
namespace {

/// SI value = factor * number + offset. The first unit of a dimension is the SI unit.
struct Unit {
  std::string_view symbol;
  Dimension dimension;
  long double factor;  // so that "30 um" is the double nearest to 3e-5
  long double offset = 0;
};

using D = Dimension;
constexpr long double pi = std::numbers::pi_v<long double>;

/// Spelled without blanks, '*' and '^': "W/(m*K)" and "W/(m K)" are both looked up as "W/(mK)".
constexpr auto units = std::to_array<Unit>({
    {"", D::none, 1},
    {"%", D::none, 0.01L},
    {"m", D::length, 1},
    {"nm", D::length, 1e-9L},
    {"um", D::length, 1e-6L},
    {"mm", D::length, 1e-3L},
    {"cm", D::length, 1e-2L},
    {"m/s", D::speed, 1},
    {"um/s", D::speed, 1e-6L},
    {"mm/s", D::speed, 1e-3L},
    {"mm/min", D::speed, 1e-3L / 60},
    {"s", D::time, 1},
    {"ns", D::time, 1e-9L},
    {"us", D::time, 1e-6L},
    {"ms", D::time, 1e-3L},
    {"min", D::time, 60},
    {"kg", D::mass, 1},
    {"ug", D::mass, 1e-9L},
    {"mg", D::mass, 1e-6L},
    {"g", D::mass, 1e-3L},
    {"kg/m3", D::density, 1},
    {"g/cm3", D::density, 1e3L},
    {"Pa", D::pressure, 1},
    {"kPa", D::pressure, 1e3L},
    {"MPa", D::pressure, 1e6L},
    {"GPa", D::pressure, 1e9L},
    {"J/m2", D::surface_energy, 1},
    {"mJ/m2", D::surface_energy, 1e-3L},
    {"N/m", D::surface_energy, 1},
    {"mN/m", D::surface_energy, 1e-3L},
    {"J/m3", D::energy_density, 1},
    {"kJ/m3", D::energy_density, 1e3L},
    {"MJ/m3", D::energy_density, 1e6L},
    {"J/mm3", D::energy_density, 1e9L},
    {"W", D::power, 1},
    {"mW", D::power, 1e-3L},
    {"kW", D::power, 1e3L},
    {"K", D::temperature, 1},
    {"degC", D::temperature, 1, 273.15L},
    {"rad", D::angle, 1},
    {"deg", D::angle, pi / 180},
    {"rad/s", D::angular_speed, 1},
    {"deg/s", D::angular_speed, pi / 180},
    {"deg/ms", D::angular_speed, pi / 0.18L},
    {"W/(m K)", D::conductivity, 1},
    {"W/(mK)", D::conductivity, 1},
    {"W/mK", D::conductivity, 1},
    {"W/m/K", D::conductivity, 1},
    {"mW/(mK)", D::conductivity, 1e-3L},
    {"J/(kg K)", D::specific_heat, 1},
    {"J/(kgK)", D::specific_heat, 1},
    {"J/kgK", D::specific_heat, 1},
    {"J/kg/K", D::specific_heat, 1},
    {"kJ/(kgK)", D::specific_heat, 1e3L},
    {"J/(gK)", D::specific_heat, 1e3L},
    {"J/kg", D::specific_energy, 1},
    {"kJ/kg", D::specific_energy, 1e3L},
    {"MJ/kg", D::specific_energy, 1e6L},
    {"J/g", D::specific_energy, 1e3L},
    {"kg/mol", D::molar_mass, 1},
    {"g/mol", D::molar_mass, 1e-3L},
    {"Pas", D::viscosity, 1},
    {"mPas", D::viscosity, 1e-3L},
    {"N/(m K)", D::surface_tension_slope, 1},
    {"N/(mK)", D::surface_tension_slope, 1},
    {"mN/(mK)", D::surface_tension_slope, 1e-3L},
    {"W/(m2 K)", D::heat_transfer, 1},
    {"W/(m2K)", D::heat_transfer, 1},
    {"W/m2K", D::heat_transfer, 1},
    {"kg/s", D::mass_rate, 1},
    {"mg/s", D::mass_rate, 1e-6L},
    {"ug/s", D::mass_rate, 1e-9L},
    {"C/m2", D::charge_density, 1},
    {"uC/m2", D::charge_density, 1e-6L},
    {"Hz", D::frequency, 1},
    {"kHz", D::frequency, 1e3L},
    {"kg/m", D::linear_density, 1},
    {"g/m", D::linear_density, 1e-3L},
});

std::string without_blanks(std::string_view text) {
  std::string compact;
  for (char const c : text) {
    if (c != ' ' && c != '\t' && c != '*' && c != '^') compact += c;
  }
  return compact;
}

Unit const* find_unit(std::string_view symbol, Dimension dimension) {
  for (Unit const& unit : units) {
    if (unit.dimension == dimension && unit.symbol == symbol) return &unit;
  }
  return nullptr;
}

std::vector<std::string> symbols(Dimension dimension) {
  std::vector<std::string> found;
  for (Unit const& unit : units) {
    if (unit.dimension == dimension && !unit.symbol.empty()) found.emplace_back(unit.symbol);
  }
  return found;
}

std::string_view name(Dimension dimension) {
  switch (dimension) {
    case D::none:
      return "a plain number";
    case D::length:
      return "a length";
    case D::speed:
      return "a speed";
    case D::time:
      return "a time";
    case D::mass:
      return "a mass";
    case D::density:
      return "a density";
    case D::pressure:
      return "a pressure";
    case D::surface_energy:
      return "an energy per area";
    case D::energy_density:
      return "an energy per volume";
    case D::power:
      return "a power";
    case D::temperature:
      return "a temperature";
    case D::angle:
      return "an angle";
    case D::angular_speed:
      return "an angular speed";
    case D::conductivity:
      return "a thermal conductivity";
    case D::specific_heat:
      return "a specific heat";
    case D::specific_energy:
      return "an energy per mass";
    case D::molar_mass:
      return "a molar mass";
    case D::viscosity:
      return "a viscosity";
    case D::charge_density:
      return "a charge per area";
    case D::surface_tension_slope:
      return "a surface tension per temperature";
    case D::heat_transfer:
      return "a heat transfer coefficient";
    case D::mass_rate:
      return "a mass per time";
    case D::frequency:
      return "a frequency";
    case D::linear_density:
      return "a mass per length";
  }
  return "";
}

/// Tells what is wrong with a unit: another dimension's, misspelt, or none at all.
std::string unit_fault(std::string_view text, std::string const& symbol, Dimension dimension) {
  std::vector<std::string> const fitting = symbols(dimension);
  std::string const units_that_fit = fmt::format("{}: {}", name(dimension), fmt::join(fitting, ", "));
  if (symbol.empty()) return fmt::format("\"{}\" has no unit (must be {})", text, units_that_fit);
  if (symbol.front() == ',') return fmt::format("\"{}\" has a decimal comma (must be a point)", text);
  for (Unit const& unit : units) {
    if (unit.symbol != symbol) continue;
    return fmt::format("\"{}\" is {} (must be {})", text, name(unit.dimension), units_that_fit);
  }
  return fmt::format("\"{}\" has the unknown unit \"{}\" (must be {})", text, symbol, units_that_fit);
}

}  // namespace

std::string_view si_unit(Dimension dimension) {
  for (Unit const& unit : units) {
    if (unit.dimension == dimension) return unit.symbol;
  }
  return "";
}

double parse_quantity(std::string_view text, Dimension dimension) {
  std::string_view rest = text;
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  if (rest.size() > 1 && rest.front() == '+' && rest[1] != '-') rest.remove_prefix(1);
  long double number = 0;
  auto const [end, fault] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (fault != std::errc{} || !std::isfinite(static_cast<double>(number))) {
    throw InputError(fmt::format("\"{}\" is not a number{} (must be {}{})", text,
                                 dimension == D::none ? "" : " with a unit", name(dimension),
                                 dimension == D::none ? "" : fmt::format(": {}", fmt::join(symbols(dimension), ", "))));
  }
  std::string const symbol = without_blanks(rest.substr(static_cast<std::size_t>(end - rest.data())));
  Unit const* const unit = find_unit(symbol, dimension);
  if (!unit) throw InputError(unit_fault(text, symbol, dimension));
  return static_cast<double>(unit->factor * number + unit->offset);
}

std::string format_quantity(double value, Dimension dimension) {
  struct Shown {
    Dimension dimension;
    std::vector<std::string_view> symbols;  // ascending
  };
  static std::vector<Shown> const preferred = {
      {D::length, {"nm", "um", "mm", "m"}},      {D::speed, {"mm/s", "m/s"}},   {D::time, {"ns", "us", "ms", "s"}},
      {D::mass, {"ug", "mg", "g", "kg"}},        {D::power, {"mW", "W", "kW"}}, {D::angle, {"deg"}},
      {D::pressure, {"Pa", "kPa", "MPa", "GPa"}}};
  Unit const* chosen = find_unit(si_unit(dimension), dimension);
  for (Shown const& shown : preferred) {
    if (shown.dimension != dimension || value == 0 || !std::isfinite(value)) continue;
    chosen = find_unit(shown.symbols.front(), dimension);
    for (std::string_view const symbol : shown.symbols) {
      Unit const* const unit = find_unit(symbol, dimension);
      if (std::abs(value) >= unit->factor * (1 - 1e-9L)) chosen = unit;
    }
  }
  auto const shown_value = static_cast<double>(value / chosen->factor);
  bool const long_number = std::abs(shown_value) >= 1e4 && std::abs(shown_value) < 1e6;  // 25000 rather than 2.5e+04
  std::string const number = fmt::format("{:.{}g}", shown_value, long_number ? 6 : 4);
  return chosen->symbol.empty() ? number : fmt::format("{} {}", number, chosen->symbol);
}

}  // namespace layerloop
