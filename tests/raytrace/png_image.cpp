#include "core/png_image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>

#include "core/write_file.hpp"

namespace layerloop {
namespace {

/// Decoded by libpng, which did not see the original.
Image decode(std::string const& bytes) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()));
  header.format = PNG_FORMAT_RGB;
  Image image{static_cast<std::int32_t>(header.width), static_cast<std::int32_t>(header.height), {}};
  image.rgb.resize(PNG_IMAGE_SIZE(header));
  EXPECT_TRUE(png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr));
  return image;
}

Image pattern() {
  Image image{37, 11, {}};
  for (int i = 0; i < 3 * 37 * 11; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i * i + 3 * i));
  return image;
}

TEST(PngImage, ComesBackAsItWas) {
  Image const image = pattern(), back = decode(encode_png(image));
  EXPECT_EQ(back.width, image.width);
  EXPECT_EQ(back.height, image.height);
  EXPECT_EQ(back.rgb, image.rgb);
}

TEST(PngImage, FileHoldsTheEncodedBytes) {
  std::filesystem::path const path = std::filesystem::path(testing::TempDir()) / "layerloop_png_image_test.png";
  write_png(pattern(), path);
  EXPECT_EQ(read_file(path), encode_png(pattern()));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace layerloop
