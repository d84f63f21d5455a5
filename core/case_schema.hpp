#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/case.hpp"
#include "core/units.hpp"

namespace layerloop {

/// Bounds of a number, in SI. Written wide enough for any real machine and narrow enough to catch a slip of 1000.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  enum class End { closed, open } lower = End::closed;

  bool contains(double value) const {  // false for NaN
    return (lower == End::open ? value > min : value >= min) && value <= max;
  }
};

/// Who has to give a key that has no default.
enum class Need {
  always,
  with_laser,           ///< unless machine.frozen_zone takes the laser's place or powder is only spread
  with_light,           ///< with a laser, or for the verb absorb
  with_spot,            ///< with a laser, or for the verb absorb without optics.uniform_beam
  with_part,            ///< unless powder is only spread
  with_energy_density,  ///< with contact.cohesion "sjkr" or "sjkr2"
  with_surface_energy,  ///< with contact.cohesion "jkr" or "dmt"
  with_blade,           ///< unless machine.recoater is "roller"
  never
};

template <class T>
using Member = std::function<T&(Case&)>;

/// A word out of a fixed list.
struct Choice {
  std::vector<std::string> words;
  std::function<std::size_t(Case const&)> get;
  std::function<void(Case&, std::size_t)> set;
};

/// Where a key's value goes; its type says what may be written.
using Target =
    std::variant<Member<double>, Member<std::optional<double>>, Member<std::vector<double>>,
                 Member<std::optional<std::array<double, 2>>>, Member<std::complex<double>>, Member<PropertyTable>,
                 Member<std::int64_t>, Member<std::uint64_t>, Member<bool>, Member<std::string>, Choice>;

/// One row of the schema: all there is to know about one key of the case file. Parsing, checking, the resolved case and
/// the page of keys come from it, so a new key is one row here and one member in core/case.hpp.
struct CaseKey {
  std::string table;  ///< "laser"; "material" stands for any [material.NAME]; an effect has rows of its own
  std::string key;    ///< of [powder.mixture]: NAME, for any material
  Target target;
  Dimension dimension = Dimension::none;
  Range range;
  Need need = Need::always;
  std::string fallback;  ///< default as one would write it; "=contact.sliding_friction": that key's value; "": none
  std::string sentence;
};

std::vector<CaseKey> const& case_schema();

/// Rows of [powder.mixture] and of [contact.NAME], [contact.NAME.NAME] for these names. The schema holds them for NAME,
/// and those of [contact.wall]; a case has those of the names that it gives.
CaseKey mixture_row(std::string const& material);
std::vector<CaseKey> body_rows(std::string const& body);
std::vector<CaseKey> pair_rows(std::string const& a, std::string const& b);
/// Rows of [modifiers.NAME].
std::vector<CaseKey> modifier_rows(std::string const& name);
bool is_of_names(CaseKey const& row);

/// Table under which the schema has the rows of a table: "material" for "material.Cu", "contact.NAME" for "contact.Cu".
std::string family_of(std::string const& table);

/// Whether a case has to give the key, unless it has a default.
bool is_needed(CaseKey const& row, Case const& c);

std::string name_of(CaseKey const& row);  ///< "laser.power"

std::string shown_range(CaseKey const& row);  ///< "[1 um, 2 mm]"; empty without bounds

/// The row of a key as it stands in a file, where `table` may be "material.IN718" or "contact.Cu.wall"; null when there
/// is none.
CaseKey const* find_key(std::string const& table, std::string const& key);

/// Names of the tables, with "material.NAME" for any material.
std::vector<std::string> const& case_tables();

/// Default that a preset puts in the place of the row's own, as TOML; empty when it has none for the key.
std::string preset_value(std::string const& preset, std::string const& table, std::string const& key);

}  // namespace layerloop
