#include "validation/blind/seal.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <array>
#include <cstring>

#include "core/error.hpp"

namespace layerloop::validation {
namespace {

using Bytes = std::array<unsigned char, crypto_generichash_BYTES>;
static_assert(crypto_generichash_BYTES == crypto_secretbox_KEYBYTES);

unsigned char const* bytes_of(std::string_view text) { return reinterpret_cast<unsigned char const*>(text.data()); }

/// A different one for every purpose.
Bytes derived(std::uint64_t seed, std::string const& set, std::string const& id, std::string const& purpose) {
  std::string const text = fmt::format("layerloop blind {} {} {} {}", purpose, seed, set, id);
  Bytes bytes{};
  crypto_generichash(bytes.data(), bytes.size(), bytes_of(text), text.size(), nullptr, 0);
  return bytes;
}

}  // namespace

std::uint64_t secret_of(std::uint64_t seed, std::string const& set, std::string const& id) {
  Bytes const bytes = derived(seed, set, id, "scenario");
  std::uint64_t secret = 0;
  std::memcpy(&secret, bytes.data(), sizeof secret);
  return secret;
}

std::string seal(std::string_view text, std::uint64_t seed, std::string const& set, std::string const& id) {
  Bytes const key = derived(seed, set, id, "key"), nonce = derived(seed, set, id, "nonce");
  std::string box(crypto_secretbox_MACBYTES + text.size(), '\0');
  crypto_secretbox_easy(reinterpret_cast<unsigned char*>(box.data()), bytes_of(text), text.size(), nonce.data(),
                        key.data());
  return box;
}

std::string unseal(std::string_view box, std::uint64_t seed, std::string const& set, std::string const& id) {
  Bytes const key = derived(seed, set, id, "key"), nonce = derived(seed, set, id, "nonce");
  if (box.size() < crypto_secretbox_MACBYTES) throw InputError("the sealed answer of " + id + " is cut short");
  std::string text(box.size() - crypto_secretbox_MACBYTES, '\0');
  if (crypto_secretbox_open_easy(reinterpret_cast<unsigned char*>(text.data()), bytes_of(box), box.size(), nonce.data(),
                                 key.data()) != 0)
    throw InputError(
        fmt::format("the sealed answer of {} does not open (it was sealed with another --seed, or changed since)", id));
  return text;
}

}  // namespace layerloop::validation
