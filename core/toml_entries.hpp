#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace layerloop {

/// Where something was written: in the file, or in a --set option.
struct Place {
  std::uint32_t line = 1, column = 1;
  std::string option;  ///< `--set laser.power=180W`; empty: in the file

  auto operator<=>(Place const&) const = default;
};

/// Something that the user has to mend.
struct Fault {
  Place place;
  std::string message;
};

/// Tells every fault in one message, in the order of the file, those of options last: "case.toml:12:1: unknown key
/// ...". \throws InputError  always
[[noreturn]] void throw_faults(std::vector<Fault> faults, std::string const& file);

/// A value as the user wrote it, before any unit is looked at. What TOML knows but no key takes (a date, a table) has
/// only its name.
struct TomlValue {
  struct Other {
    std::string kind;
  };
  std::variant<bool, std::int64_t, double, std::string, std::vector<TomlValue>, Other> content;
};

std::string shown(TomlValue const& value);  ///< as it would be written in a file, for messages

struct TomlEntry {
  std::string table, key;  ///< table "laser", "material.IN718", ...; "" outside of any table
  TomlValue value;
  Place place;
};

struct TomlContent {
  std::vector<TomlEntry> entries;       ///< no two with the same table and key
  std::map<std::string, Place> tables;  ///< where each table begins
};

/// A syntax error: toml++ and the guard before it stop at the first one.
struct SyntaxFault {
  Fault fault;
};

/// Reads tables of one level, of two levels below `material` and `effects`, of three below `contact`, and
/// `powder.mixture`. What stands in [sweep.vary] has the table "sweep.vary" and a key with dots: "laser.power".
/// Hostile text (depth, control bytes, size) is turned away before toml++ sees it. \throws SyntaxFault
TomlContent parse_toml(std::string_view text);

/// One table, or one item of a list of tables.
struct TomlTable {
  std::string name;  ///< "study" of [study], "calibration" of [[calibration]]; "" outside of any table
  Place place;
  std::vector<TomlEntry> entries;
};

/// Reads tables of one level and lists of such tables, in the order of the file. \throws SyntaxFault
std::vector<TomlTable> parse_tables(std::string_view text);

/// One value as it stands behind the equals sign. \throws SyntaxFault
TomlValue parse_value(std::string_view text);

/// One `table.key=value` of a --set option; text needs no quotes there: `laser.power=180 W`. \throws SyntaxFault
TomlEntry parse_override(std::string const& option);

}  // namespace layerloop
