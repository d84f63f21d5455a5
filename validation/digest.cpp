#include "validation/digest.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <array>

#include "core/write_file.hpp"

namespace layerloop::validation {

std::string sha256_of_file(std::filesystem::path const& path) {
  std::string const bytes = read_file(path);
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest;
  crypto_hash_sha256(digest.data(), reinterpret_cast<unsigned char const*>(bytes.data()), bytes.size());
  std::string text;
  for (unsigned char const byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace layerloop::validation
