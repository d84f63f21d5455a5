#include "core/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace layerloop {

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      int const replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = last;
    last = row;
  }
  return last[b.size()];
}

std::optional<std::string> likely_name(std::string_view written, std::vector<std::string> const& known) {
  std::optional<std::string> nearest;
  int nearest_distance = 3;
  for (std::string const& name : known) {
    if (name.size() > written.size() + 2 || written.size() > name.size() + 2) continue;
    int const distance = edit_distance(written, name);
    if (distance < nearest_distance && 3 * distance <= static_cast<int>(name.size())) {
      nearest = name;
      nearest_distance = distance;
    }
  }
  return nearest;
}

std::string did_you_mean(std::string_view written, std::vector<std::string> const& known) {
  std::optional<std::string> const name = likely_name(written, known);
  return name ? fmt::format("; did you mean \"{}\"?", *name) : "";
}

}  // namespace layerloop
