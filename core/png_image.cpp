#include "core/png_image.hpp"

#include <fmt/format.h>
#include <png.h>

#include "core/error.hpp"
#include "core/write_file.hpp"

namespace layerloop {

std::string encode_png(Image const& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;

  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(header), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr)) {
    throw FileError(
        fmt::format("cannot encode a picture of {} x {} pixels ({})", image.width, image.height, header.message));
  }
  bytes.resize(size);
  return bytes;
}

void write_png(Image const& image, std::filesystem::path const& path) { write_file(path, encode_png(image)); }

}  // namespace layerloop
