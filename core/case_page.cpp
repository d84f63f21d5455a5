#include <fmt/format.h>

#include "core/case_file.hpp"
#include "core/case_schema.hpp"
#include "core/case_values.hpp"

namespace layerloop {
namespace {

/// What may be written: a unit, a list of words, a kind of value.
std::string value_column(CaseKey const& row) {
  if (auto const* const choice = std::get_if<Choice>(&row.target)) {
    std::string words;
    for (std::string const& word : choice->words) words += fmt::format("{}`\"{}\"`", words.empty() ? "" : ", ", word);
    return words;
  }
  if (std::holds_alternative<Member<bool>>(row.target)) return "true, false";
  if (std::holds_alternative<Member<std::string>>(row.target)) return "text";
  bool const whole = std::holds_alternative<Member<std::int64_t>>(row.target) ||
                     std::holds_alternative<Member<std::uint64_t>>(row.target);
  std::string const unit(si_unit(row.dimension));
  std::string const kind = whole ? "whole number" : unit.empty() ? "number" : unit;
  if (std::holds_alternative<Member<std::vector<double>>>(row.target)) return fmt::format("list, {}", kind);
  return kind;
}

std::string default_column(CaseKey const& row) {
  if (row.fallback.starts_with('=')) return fmt::format("`{}`", row.fallback.substr(1));
  if (!row.fallback.empty()) return fmt::format("`{}`", row.fallback);
  switch (row.need) {
    case Need::always:
      return row.table == "material" ? "built-in" : "required";
    case Need::with_laser:
      return row.table == "material" ? "built-in" : "required (not with `frozen_zone` or for `spread`)";
    case Need::with_light:
      return "required (not with `frozen_zone` or for `spread`)";
    case Need::with_spot:
      return "required (not with `frozen_zone`, `uniform_beam` or for `spread`)";
    case Need::with_part:
      return "required (not for `spread`)";
    case Need::with_energy_density:
      return "required with `sjkr`, `sjkr2`";
    case Need::with_surface_energy:
      return "required with `jkr`, `dmt`";
    case Need::with_blade:
      return "required (not with a roller)";
    case Need::never:
      return "none";
  }
  return "";
}

/// Appends a row that has a value, after the head of its table where that is a new one.
void write_row(std::string& text, std::string& table, CaseKey const& row, std::string const& head,
               Case const& checked) {
  std::optional<std::string> const value = stored(row, checked);
  bool const never_given = !is_needed(row, checked) && row.fallback.empty() && value == stored(row, Case{});
  if (!value || never_given) return;
  if (head != table) text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", head);
  table = head;
  text += fmt::format("{} = {}\n", row.key, *value);
}

/// [powder.mixture], [contact.A], [contact.A.B] and [modifiers.A] of the names that the case gives.
void write_tables_of_names(std::string& text, std::string& table, Case const& checked) {
  for (auto const& [name, share] : checked.powder.mixture) {
    CaseKey row = mixture_row(name);
    row.key = toml_text(name);
    write_row(text, table, row, row.table, checked);
  }
  for (auto const& [name, body] : checked.bodies)
    for (CaseKey const& row : body_rows(name)) write_row(text, table, row, "contact." + toml_text(name), checked);
  for (auto const& [names, pair] : checked.pairs)
    for (CaseKey const& row : pair_rows(names[0], names[1]))
      write_row(text, table, row, fmt::format("contact.{}.{}", toml_text(names[0]), toml_text(names[1])), checked);
  for (auto const& [name, modifier] : checked.modifiers)
    for (CaseKey const& row : modifier_rows(name)) write_row(text, table, row, "modifiers." + toml_text(name), checked);
}
}  // namespace

std::string resolved_toml(Case const& checked) {
  std::string text, table;
  for (CaseKey const& row : case_schema()) {
    if (row.table != "material" && !is_of_names(row)) write_row(text, table, row, row.table, checked);
  }
  Case with = checked;
  for (Material const& metal : checked.materials()) {
    with.material = metal;
    for (CaseKey const& row : case_schema())
      if (row.table == "material") write_row(text, table, row, "material." + toml_text(metal.name), with);
  }
  write_tables_of_names(text, table, checked);
  return text;
}

std::string case_key_page() {
  std::string page =
      "# Keys of the case file\n\n"
      "Written by the program from its schema table (`layerloop check --help-case`); do not edit.\n"
      "A quantity is text with a unit (`\"30 um\"`, `\"0.2 GPa\"`) or a plain number in the SI unit of its row. "
      "The frame: z up, x the recoating direction.\n";
  std::string table;
  for (CaseKey const& row : case_schema()) {
    if (row.table != table) {
      table = row.table;
      page += fmt::format("\n## [{}]\n\n| key | value | range | default | meaning |\n|---|---|---|---|---|\n",
                          table == "material" ? "material.NAME" : table);
    }
    page += fmt::format("| `{}` | {} | {} | {} | {} |\n", row.key, value_column(row), shown_range(row),
                        default_column(row), row.sentence);
  }
  std::string metals;
  for (auto const& [name, metal] : built_in_materials())
    metals += fmt::format("{}`{}`", metals.empty() ? "" : ", ", name);
  return page + fmt::format("\nMetals known without a table: {}.\n", metals);
}

}  // namespace layerloop
