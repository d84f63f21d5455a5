#include "validation/case_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/error.hpp"
#include "core/toml_entries.hpp"

namespace layerloop::validation {
namespace {

using Lines = std::vector<std::string>;

Lines lines_of(std::string const& text) {
  Lines lines;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t const end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

std::string joined(Lines const& lines) {
  std::string text;
  for (std::string const& line : lines) text += line + '\n';
  return text;
}

TomlContent parsed(std::string const& text) {
  try {
    return parse_toml(text);
  } catch (SyntaxFault const& syntax) {
    throw InputError(syntax.fault.message);
  }
}

TomlEntry const* find(TomlContent const& content, TomlEntry const& wanted) {
  auto const found = std::ranges::find_if(
      content.entries, [&](TomlEntry const& e) { return e.table == wanted.table && e.key == wanted.key; });
  return found == content.entries.end() ? nullptr : &*found;
}

std::string line_with(TomlEntry const& entry, std::string const& remark) {
  return fmt::format("{} = {}{}{}", entry.key, shown(entry.value), remark.empty() ? "" : "  # ", remark);
}

/// Behind the last key of a table: before the blank lines and comments that lead to the next one.
std::size_t end_of_table(TomlContent const& content, std::string const& table) {
  std::size_t last = content.tables.at(table).line;
  for (TomlEntry const& e : content.entries)
    if (e.table == table) last = std::max<std::size_t>(last, e.place.line);
  return last;
}

void set_key(std::string& text, TomlEntry const& wanted, std::string const& comment) {
  TomlContent const content = parsed(text);
  Lines lines = lines_of(text);
  if (TomlEntry const* const held = find(content, wanted)) {
    std::string const was = "was " + shown(held->value);
    std::string& line = lines[held->place.line - 1];
    line = line.substr(0, line.find_first_not_of(" \t")) +
           line_with(wanted, comment.empty() ? was : fmt::format("{}; {}", was, comment));
  } else if (content.tables.contains(wanted.table)) {
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(end_of_table(content, wanted.table)),
                 line_with(wanted, comment));
  } else {
    lines.insert(lines.end(), {"", fmt::format("[{}]", wanted.table), line_with(wanted, comment)});
  }
  text = joined(lines);
}

bool same(TomlContent const& a, TomlContent const& b, std::vector<TomlEntry> const& changed) {
  auto const is_changed = [&](TomlEntry const& e) {
    return std::ranges::any_of(changed, [&](auto const& c) { return c.table == e.table && c.key == e.key; });
  };
  auto const all_in = [&](TomlContent const& some, TomlContent const& others) {
    return std::ranges::all_of(some.entries, [&](TomlEntry const& e) {
      TomlEntry const* const other = find(others, e);
      return is_changed(e) || (other && shown(other->value) == shown(e.value));
    });
  };
  auto const as_wanted = [&](TomlEntry const& c) {
    TomlEntry const* const now = find(b, c);
    return now && shown(now->value) == shown(c.value);
  };
  return all_in(a, b) && all_in(b, a) && std::ranges::all_of(changed, as_wanted);
}

}  // namespace

std::string with_settings(std::string text, std::vector<std::string> const& settings, std::string const& comment) {
  TomlContent const before = parsed(text);
  std::vector<TomlEntry> wanted;
  for (std::string const& setting : settings) wanted.push_back(parse_override(setting));
  std::optional<TomlContent> after;
  try {
    for (TomlEntry const& entry : wanted) set_key(text, entry, comment);
    after = parse_toml(text);
  } catch (std::exception const&) {
  } catch (SyntaxFault const&) {
  }
  if (!after || !same(before, *after, wanted))
    throw InputError(
        fmt::format("cannot write {} into the case (a key shares its line with others, or its value goes "
                    "over several lines) give every key a line of its own",
                    fmt::join(settings, ", ")));
  return text;
}

}  // namespace layerloop::validation
