#pragma once
#include <string_view>

namespace layerloop {

/// The text that optical_data() is read from.
extern std::string_view const optical_tables;

}  // namespace layerloop
