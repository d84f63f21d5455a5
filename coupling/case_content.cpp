#include "coupling/case_content.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include "core/case_file.hpp"
#include "core/write_file.hpp"

namespace layerloop::coupling {

std::string hash_of(std::string const& text) {
  XXH128_hash_t const hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string content_of(Case checked) {
  std::string files;
  checked.name.clear();
  for (std::string* file :
       {&checked.machine.substrate, &checked.powder.bed, &checked.laser.profile_file, &checked.scan.path}) {
    if (!file->empty()) files += hash_of(read_file(*file)) + "\n";
    file->clear();
  }
  return fmt::format("layerloop {}\n{}{}", LAYERLOOP_VERSION, files, resolved_toml(checked));
}

}  // namespace layerloop::coupling
