#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace layerloop {

/// Edits (insert, delete, replace, swap of neighbours) that turn one word into the other: optimal string alignment.
int edit_distance(std::string_view a, std::string_view b);

/// The known name that was probably meant: the nearest one, at most 2 edits and at most a third of its length away.
std::optional<std::string> likely_name(std::string_view written, std::vector<std::string> const& known);

/// `; did you mean "power"?`, or nothing when no known name is near.
std::string did_you_mean(std::string_view written, std::vector<std::string> const& known);

}  // namespace layerloop
