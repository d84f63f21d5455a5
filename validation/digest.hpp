#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace layerloop::validation {

/// SHA-256 of a text, as 64 hexadecimal digits.
std::string sha256(std::string_view text);

/// SHA-256 of a file's bytes, as 64 hexadecimal digits. \throws FileError
std::string sha256_of_file(std::filesystem::path const& path);

}  // namespace layerloop::validation
