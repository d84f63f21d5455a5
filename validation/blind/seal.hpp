#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace layerloop::validation {

/// Random number seed of one scenario: nobody can tell it from the id without the secret.
std::uint64_t secret_of(std::uint64_t seed, std::string const& set, std::string const& id);

/// Closes a text with a key that follows from seed, set and id (libsodium's secretbox: XSalsa20 and Poly1305). The same
/// input gives the same box. It keeps the analysis honest, not an adversary out: seeds can be guessed.
std::string seal(std::string_view text, std::uint64_t seed, std::string const& set, std::string const& id);

/// \throws InputError  another seed closed the box, or it was changed
std::string unseal(std::string_view box, std::uint64_t seed, std::string const& set, std::string const& id);

}  // namespace layerloop::validation
