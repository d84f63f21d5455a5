#include "core/case_key.hpp"

#include <fmt/format.h>

#include "core/spelling.hpp"

namespace layerloop {

bool takes_number(CaseKey const& row) {
  Target const& target = row.target;
  return std::holds_alternative<Member<double>>(target) ||
         std::holds_alternative<Member<std::optional<double>>>(target) ||
         std::holds_alternative<Member<std::int64_t>>(target) ||
         std::holds_alternative<Member<std::uint64_t>>(target) || std::holds_alternative<Member<PropertyTable>>(target);
}

CaseKey const* case_key(std::string const& name) {
  std::size_t const dot = name.rfind('.');
  return dot == std::string::npos ? nullptr : find_key(name.substr(0, dot), name.substr(dot + 1));
}

std::string likely_case_key(std::string const& name, std::vector<std::string> const& others) {
  std::vector<std::string> names = others;
  for (CaseKey const& row : case_schema()) {
    if (row.key == name && !is_of_names(row) && !row.table.starts_with("effects."))
      return fmt::format("; did you mean \"{}\"?", name_of(row));
    names.push_back(name_of(row));
  }
  return did_you_mean(name, names);
}

}  // namespace layerloop
