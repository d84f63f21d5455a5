#include "validation/display.hpp"

#include <fmt/format.h>

#include <numbers>

#include "core/case_schema.hpp"
#include "validation/quantity.hpp"

namespace layerloop::validation {
namespace {

Dimension dimension_of(std::string const& name) {
  if (Quantity const* const quantity = find_quantity(name)) return quantity->dimension;
  std::size_t const dot = name.rfind('.');
  if (dot == std::string::npos) return Dimension::none;
  CaseKey const* const row = find_key(name.substr(0, dot), name.substr(dot + 1));
  return row ? row->dimension : Dimension::none;
}

}  // namespace

Display display_of(std::string const& name) {
  Dimension const dimension = dimension_of(name);
  switch (dimension) {
    case Dimension::length:
      return {dimension, "um", 1e6};
    case Dimension::speed:
      return {dimension, "mm/s", 1e3};
    case Dimension::angle:
      return {dimension, "deg", 180 / std::numbers::pi};
    default:
      return {dimension, std::string(si_unit(dimension)), 1};
  }
}

std::string value_in_words(std::string const& name, double value) {
  Display const shown = display_of(name);
  return fmt::format("{} = {:.4g}{}{}", name, value * shown.factor, shown.unit.empty() ? "" : " ", shown.unit);
}

}  // namespace layerloop::validation
