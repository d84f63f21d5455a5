#pragma once
#include <string>

#include "core/case.hpp"

namespace layerloop::coupling {

/// Name of a text by its content: 32 hexadecimal digits (XXH3, 128 bits; not against an adversary).
std::string hash_of(std::string const& text);

/// The case, the files that it names and the version of the program as one text: equal texts compute the same. Its
/// name and where its files lie do not matter. \throws FileError
std::string content_of(Case checked);

}  // namespace layerloop::coupling
