#include "core/toml_entries.hpp"

// toml++ 3.3 ends the program on some broken input unless asserts are off and depth is bounded (its issues 292, 293),
// so it lives in this file only, behind `guarded`. The header is compiled in: Debian's library has other limits.
#ifndef NDEBUG
#define NDEBUG
#endif
#undef TOML_HEADER_ONLY
#undef TOML_SHARED_LIB
#define TOML_HEADER_ONLY 1
#define TOML_EXCEPTIONS 0
#define TOML_MAX_NESTED_VALUES 64
#define TOML_ENABLE_FORMATTERS 0
#define TOML_ENABLE_WINDOWS_COMPAT 0
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <tuple>

#include "core/error.hpp"

namespace layerloop {
namespace {

constexpr std::size_t largest_file = 1 << 20;
constexpr int most_dots = 64;

/// Walks over a file once: blanks comments (which may hold any character), turns away what toml++ must not see. The
/// text keeps its lines and columns.
class Guard {
 public:
  explicit Guard(std::string_view text) : text_(text) {}

  std::string cleaned() {
    if (text_.size() > largest_file) throw SyntaxFault{{{}, "the file is larger than 1 MiB (a case has a few kB)"}};
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
    std::string clean;
    clean.reserve(text_.size());
    while (at_ < text_.size()) {
      if (quote_ == 0 && text_[at_] == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (quote_ != 0 && text_.substr(at_).starts_with("\xC2\xB5")) {  // micro sign, as in "30 um"
        clean += 'u';
        step(2);
      } else {
        check(text_[at_]);
        clean += text_[at_];
        step(1);
      }
    }
    return clean;
  }

 private:
  [[noreturn]] void refuse(std::string const& message) const { throw SyntaxFault{{place_, message}}; }

  void step(std::size_t bytes) {
    bool const line_ends = text_[at_] == '\n';
    place_.line += line_ends ? 1 : 0;
    place_.column = line_ends ? 1 : place_.column + 1;
    at_ += bytes;
  }

  void check(char c) {
    auto const byte = static_cast<unsigned char>(c);
    if (byte >= 0x7F) refuse("a character outside ASCII (only comments may hold one) write \"um\", \"degC\", \"m3\"");
    if (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') refuse("a control character (the file must be plain text)");
    if (c == '\n') {
      quote_ = 0;
      dots_ = 0;
    } else if (quote_ != 0) {
      if (c == quote_ && !escaped_) quote_ = 0;
      escaped_ = quote_ == '"' && c == '\\' && !escaped_;
    } else if (c == '"' || c == '\'') {
      if (text_.substr(at_).starts_with(std::string(3, c))) refuse("text over several lines (no key takes it)");
      quote_ = c;
      escaped_ = false;
    } else if (c == '.') {
      if (++dots_ > most_dots)
        refuse(fmt::format("a key with more than {} dots (tables have one or two levels)", most_dots));
    } else if (std::string_view(",=[]{}").find(c) != std::string_view::npos) {
      dots_ = 0;
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Place place_;
  char quote_ = 0;  // the quotation mark that closes the text we are in
  bool escaped_ = false;
  int dots_ = 0;  // since the last character that ends a key
};

Place place_of(toml::source_region const& region) { return {region.begin.line, region.begin.column, {}}; }

toml::table parse_guarded(std::string_view text) {
  toml::parse_result result = toml::parse(Guard(text).cleaned());
  if (!result) {
    toml::parse_error const& error = result.error();
    std::string_view const what = error.description();
    throw SyntaxFault{{place_of(error.source()), std::string(what.substr(0, what.find(" (TOML_")))}};
  }
  return std::move(result).table();
}

TomlValue plain_value(toml::node const& node) {
  if (auto const* const flag = node.as_boolean()) return {flag->get()};
  if (auto const* const number = node.as_integer()) return {number->get()};
  if (auto const* const number = node.as_floating_point()) return {number->get()};
  if (auto const* const text = node.as_string()) return {text->get()};
  if (node.is_table()) return {TomlValue::Other{"a table"}};
  if (!node.is_array()) return {TomlValue::Other{"a date or time"}};
  std::vector<TomlValue> items;
  for (toml::node const& item : *node.as_array()) items.push_back(plain_value(item));
  return {std::move(items)};
}

/// May a table hold one of this name?
bool holds_table(std::string const& name, std::string_view key) {
  bool const of_material = name.starts_with("contact.") && name.find('.', 8) == std::string::npos;
  return name == "material" || name == "effects" || name == "modifiers" || name == "contact" || of_material ||
         (name == "powder" && key == "mixture") || (name == "sweep" && key == "vary");
}

constexpr std::string_view varied = "sweep.vary";  // its keys are those of the case: machine.recoating_speed

void add_varied(TomlContent& content, std::string const& before, toml::table const& table) {
  for (auto const& [key, node] : table) {
    std::string const name = before + std::string(key.str());
    if (node.is_table()) {
      add_varied(content, name + ".", *node.as_table());
    } else {
      content.entries.push_back({std::string(varied), name, plain_value(node), place_of(key.source())});
    }
  }
}

void add_table(TomlContent& content, std::string const& name, toml::table const& table, Place const& place) {
  content.tables.emplace(name, place);
  if (name == varied) return add_varied(content, "", table);
  for (auto const& [key, node] : table) {
    Place const key_place = place_of(key.source());
    if (node.is_table() && holds_table(name, key.str())) {
      add_table(content, name + "." + std::string(key.str()), *node.as_table(), key_place);
    } else {
      content.entries.push_back({name, std::string(key.str()), plain_value(node), key_place});
    }
  }
}

}  // namespace

void throw_faults(std::vector<Fault> faults, std::string const& file) {
  auto const order = [](Fault const& fault) {
    return std::tuple(!fault.place.option.empty(), fault.place.line, fault.place.column);
  };
  std::stable_sort(faults.begin(), faults.end(), [&](Fault const& a, Fault const& b) { return order(a) < order(b); });
  std::string all;
  for (Fault const& fault : faults) {
    Place const& place = fault.place;
    std::string const where =
        place.option.empty() ? fmt::format("{}:{}:{}", file, place.line, place.column) : place.option;
    all += fmt::format("{}{}: {}", all.empty() ? "" : "\n", where, fault.message);
  }
  throw InputError(all);
}

std::string shown(TomlValue const& value) {
  struct Show {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
    std::string operator()(double number) const { return fmt::format("{}", number); }
    std::string operator()(std::string const& text) const { return fmt::format("\"{}\"", text); }
    std::string operator()(TomlValue::Other const& other) const { return other.kind; }
    std::string operator()(std::vector<TomlValue> const& items) const {
      std::string text;
      for (TomlValue const& item : items) text += (text.empty() ? "" : ", ") + shown(item);
      return "[" + text + "]";
    }
  };
  std::string text = std::visit(Show{}, value.content);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

TomlContent parse_toml(std::string_view text) {
  toml::table const root = parse_guarded(text);
  TomlContent content;
  for (auto const& [key, node] : root) {
    Place const place = place_of(key.source());
    if (node.is_table()) {
      add_table(content, std::string(key.str()), *node.as_table(), place);
    } else {
      content.entries.push_back({"", std::string(key.str()), plain_value(node), place});
    }
  }
  return content;
}

std::vector<TomlTable> parse_tables(std::string_view text) {
  toml::table const root = parse_guarded(text);
  std::vector<TomlTable> tables{{}};  // the first: what stands outside of any table
  auto const add = [&](std::string_view name, toml::table const& table) {
    TomlTable one{std::string(name), place_of(table.source()), {}};
    for (auto const& [key, node] : table)
      one.entries.push_back({one.name, std::string(key.str()), plain_value(node), place_of(key.source())});
    tables.push_back(std::move(one));
  };
  for (auto const& [key, node] : root) {
    if (node.is_table()) {
      add(key.str(), *node.as_table());
    } else if (node.is_array_of_tables()) {
      for (toml::node const& item : *node.as_array()) add(key.str(), *item.as_table());
    } else {
      tables.front().entries.push_back({"", std::string(key.str()), plain_value(node), place_of(key.source())});
    }
  }
  std::ranges::stable_sort(tables, {}, [](TomlTable const& table) { return table.place; });
  return tables;
}

TomlValue parse_value(std::string_view text) {
  toml::table const parsed = parse_guarded(fmt::format("value = {}", text));
  return plain_value(*parsed.get("value"));
}

TomlEntry parse_override(std::string const& option) {
  Place const place{0, 0, "--set " + option};
  std::size_t const equals = option.find('=');
  std::string name = option.substr(0, equals);
  std::erase(name, ' ');
  std::size_t const dot = name.rfind('.');
  bool const named = dot != std::string::npos && dot > 0 && dot + 1 < name.size();
  if (equals == std::string::npos || !named || option.find('\n') != std::string::npos) {
    throw SyntaxFault{{place, "not of the form table.key=value (for example --set laser.power=180W)"}};
  }
  TomlEntry entry{name.substr(0, dot), name.substr(dot + 1), {option.substr(equals + 1)}, place};
  try {
    entry.value = parse_value(option.substr(equals + 1));
  } catch (SyntaxFault const& syntax) {
    // "180 W" is text without quotes; a list or quoted text that does not parse is a slip.
    if (option.find_first_of("[]{}\"'", equals) != std::string::npos) throw SyntaxFault{{place, syntax.fault.message}};
  }
  return entry;
}

}  // namespace layerloop
