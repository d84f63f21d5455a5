#include "validation/digest.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <array>

#include "core/write_file.hpp"

namespace layerloop::validation {

std::string sha256(std::string_view text) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
  crypto_hash_sha256(digest.data(), reinterpret_cast<unsigned char const*>(text.data()), text.size());
  std::string digits;
  for (unsigned char const byte : digest) digits += fmt::format("{:02x}", byte);
  return digits;
}

std::string sha256_of_file(std::filesystem::path const& path) { return sha256(read_file(path)); }

}  // namespace layerloop::validation
