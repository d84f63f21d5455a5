#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace layerloop {

/// An 8-bit RGB picture, rows from the top.
struct Image {
  std::int32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 * width * height
};

std::string encode_png(Image const& image);                             ///< bytes of a PNG file (libpng)
void write_png(Image const& image, std::filesystem::path const& path);  ///< aside and renamed; \throws FileError

}  // namespace layerloop
