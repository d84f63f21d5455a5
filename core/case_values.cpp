#include "core/case_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/spelling.hpp"

namespace layerloop {
namespace {

std::string in_quotes(std::vector<std::string> const& words) {
  std::string list;
  for (std::string const& word : words) list += (list.empty() ? "\"" : ", \"") + word + "\"";
  return list;
}

/// Puts one value into the member that the row names.
class Store {
 public:
  Store(CaseKey const& row, TomlValue const& value, Case& into) : row_(row), value_(value), into_(into) {}

  void operator()(Member<double> const& field) const { field(into_) = number(value_); }
  void operator()(Member<std::optional<double>> const& field) const { field(into_) = number(value_); }
  void operator()(Member<std::vector<double>> const& field) const { field(into_) = numbers(); }
  void operator()(Member<std::optional<std::array<double, 2>>> const& field) const { field(into_) = pair(value_); }
  void operator()(Member<std::complex<double>> const& field) const {
    auto const [n, k] = pair(value_);
    field(into_) = {n, k};
  }
  void operator()(Member<PropertyTable> const& field) const { field(into_) = property(); }
  void operator()(Member<std::int64_t> const& field) const { field(into_) = whole_number(); }
  void operator()(Member<std::uint64_t> const& field) const {
    field(into_) = static_cast<std::uint64_t>(whole_number());
  }
  void operator()(Member<bool> const& field) const {
    bool const* const flag = std::get_if<bool>(&value_.content);
    if (!flag) refuse("must be true or false");
    field(into_) = *flag;
  }
  void operator()(Member<std::string> const& field) const { field(into_) = text("must be text in quotation marks"); }
  void operator()(Choice const& choice) const {
    std::string const demand = "must be one of " + in_quotes(choice.words);
    std::string const written = text(demand);
    auto const word = std::find(choice.words.begin(), choice.words.end(), written);
    if (word == choice.words.end()) refuse(demand, did_you_mean(written, choice.words));
    choice.set(into_, static_cast<std::size_t>(word - choice.words.begin()));
  }

 private:
  [[noreturn]] void refuse(std::string const& why, std::string const& hint = "") const {
    throw InputError(fmt::format("{} = {} ({}){}", name_of(row_), shown(value_), why, hint));
  }

  std::string text(std::string const& demand) const {
    std::string const* const written = std::get_if<std::string>(&value_.content);
    if (!written) refuse(demand);
    bool const plain = std::all_of(written->begin(), written->end(), [](char c) { return c >= ' ' && c <= '~'; });
    if (!plain) refuse("must be plain ASCII text");
    return *written;
  }

  /// A number or text with a unit, in SI; not yet held against the range.
  double quantity(TomlValue const& value, Dimension dimension) const {
    if (auto const* const whole = std::get_if<std::int64_t>(&value.content)) return static_cast<double>(*whole);
    if (auto const* const real = std::get_if<double>(&value.content)) return *real;
    auto const* const written = std::get_if<std::string>(&value.content);
    std::string_view const unit = si_unit(dimension);
    if (written && *written == "inf" && std::isinf(row_.range.max)) return row_.range.max;
    if (!written)
      refuse(unit.empty() ? "must be a number" : fmt::format("must be a number in {} or text with a unit", unit));
    try {
      return parse_quantity(*written, dimension);
    } catch (InputError const& fault) {
      throw InputError(fmt::format("{} = {}", name_of(row_), fault.what()));
    }
  }

  double number(TomlValue const& value) const {
    double const si_value = quantity(value, row_.dimension);
    if (row_.range.contains(si_value)) return si_value;
    bool const bare = !std::holds_alternative<std::string>(value.content);
    std::string_view const hint = row_.dimension == Dimension::none ? ""
                                  : bare                            ? " Is a unit missing?"
                                                                    : " Is the unit right?";
    throw InputError(fmt::format("{} = {} (must lie in {}).{}", name_of(row_),
                                 format_quantity(si_value, row_.dimension), shown_range(row_), hint));
  }

  std::int64_t whole_number() const {
    double const real = quantity(value_, Dimension::none);
    if (real != std::floor(real)) refuse("must be a whole number");
    number(value_);
    auto const* const whole = std::get_if<std::int64_t>(&value_.content);
    return whole ? *whole : static_cast<std::int64_t>(real);
  }

  std::vector<TomlValue> const& list(std::string const& demand) const {
    auto const* const items = std::get_if<std::vector<TomlValue>>(&value_.content);
    if (!items) refuse(demand);
    return *items;
  }

  std::vector<double> numbers() const {
    std::vector<double> all;
    for (TomlValue const& item : list("must be a list: [..., ...]")) all.push_back(number(item));
    return all;
  }

  std::array<double, 2> pair(TomlValue const& value) const {
    auto const* const items = std::get_if<std::vector<TomlValue>>(&value.content);
    if (!items || items->size() != 2) refuse("must be a list of two: [..., ...]");
    return {number(items->front()), number(items->back())};
  }

  PropertyTable property() const {
    auto const* const points = std::get_if<std::vector<TomlValue>>(&value_.content);
    if (!points) return {{0}, {number(value_)}};
    PropertyTable table;
    for (TomlValue const& point : *points) {
      auto const* const items = std::get_if<std::vector<TomlValue>>(&point.content);
      if (!items || items->size() != 2) refuse("must be a number or a list of points: [[temperature, value], ...]");
      double const T = quantity(items->front(), Dimension::temperature);
      bool const ascends = table.temperature.empty() ? T >= 0 : T > table.temperature.back();
      if (!ascends || !std::isfinite(T)) refuse("temperatures must ascend and be at least 0 K");
      table.temperature.push_back(T);
      table.value.push_back(number(items->back()));
    }
    if (table.value.empty()) refuse("must hold at least one point");
    return table;
  }

  CaseKey const& row_;
  TomlValue const& value_;
  Case& into_;
};

std::string listed(std::vector<double> const& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

/// Writes the member that the row names.
struct Show {
  Case& from;  // only read: fields reach members that can be written

  using Text = std::optional<std::string>;
  Text operator()(Member<double> const& field) const { return fmt::format("{}", field(from)); }
  Text operator()(Member<std::optional<double>> const& field) const {
    return field(from) ? Text(fmt::format("{}", *field(from))) : std::nullopt;
  }
  Text operator()(Member<std::vector<double>> const& field) const { return listed(field(from)); }
  Text operator()(Member<std::optional<std::array<double, 2>>> const& field) const {
    auto const& pair = field(from);
    return pair ? Text(listed({pair->front(), pair->back()})) : std::nullopt;
  }
  Text operator()(Member<std::complex<double>> const& field) const {
    return listed({field(from).real(), field(from).imag()});
  }
  Text operator()(Member<PropertyTable> const& field) const {
    PropertyTable const& table = field(from);
    if (table.value.empty()) return std::nullopt;
    std::string points;
    for (std::size_t i = 0; i < table.value.size(); ++i) {
      points += (i == 0 ? "" : ", ") + listed({table.temperature[i], table.value[i]});
    }
    return "[" + points + "]";
  }
  Text operator()(Member<std::int64_t> const& field) const { return fmt::format("{}", field(from)); }
  Text operator()(Member<std::uint64_t> const& field) const { return fmt::format("{}", field(from)); }
  Text operator()(Member<bool> const& field) const { return field(from) ? "true" : "false"; }
  Text operator()(Member<std::string> const& field) const { return toml_text(field(from)); }
  Text operator()(Choice const& choice) const { return toml_text(choice.words.at(choice.get(from))); }
};

}  // namespace

void store(CaseKey const& row, TomlValue const& value, Case& into) { std::visit(Store(row, value, into), row.target); }

std::optional<std::string> stored(CaseKey const& row, Case const& from) {
  return std::visit(Show{const_cast<Case&>(from)}, row.target);
}

std::string toml_text(std::string_view text) {
  std::string escaped = "\"";
  for (char const c : text) {
    if (c == '"' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped + "\"";
}

}  // namespace layerloop
