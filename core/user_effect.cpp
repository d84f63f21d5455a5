#include "core/user_effect.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
#include "core/write_file.hpp"

namespace layerloop {
namespace {

/// What all libraries brought; rows and effects by the same index.
struct Loaded {
  std::vector<Plugin> plugins;
  std::vector<Effect> rows;
  std::vector<std::shared_ptr<UserEffect const>> effects;
};
Loaded& loaded() {
  static Loaded all;
  return all;
}

std::string sha256_of(std::string const& path) {
  std::string const bytes = read_file(path);
  unsigned char hash[crypto_hash_sha256_BYTES];
  crypto_hash_sha256(hash, reinterpret_cast<unsigned char const*>(bytes.data()), bytes.size());
  std::string text;
  for (unsigned char const byte : hash) text += fmt::format("{:02x}", byte);
  return text;
}

class Registry : public EffectRegistry {
 public:
  explicit Registry(std::string path) : path_(std::move(path)) {}

  void add(Effect row, std::shared_ptr<UserEffect const> effect) override {
    std::vector<Effect> const& known = loaded().rows;
    if (is_built_in(row.name) || std::ranges::find(known, row.name, &Effect::name) != known.end())
      refuse(fmt::format("brings an effect \"{}\" (the name is taken) give it another", row.name));
    if (!effect) refuse(fmt::format("registers \"{}\" without what it does", row.name));
    row.enabled = "false";
    row.file = path_;
    loaded().rows.push_back(std::move(row));
    loaded().effects.push_back(std::move(effect));
  }

  [[noreturn]] void refuse(std::string const& why) const { throw InputError("--plugin " + path_ + ": " + why); }

 private:
  std::string path_;
};

}  // namespace

void load_plugin(std::string const& path) {
  Registry registry(path);
  std::string const full = std::filesystem::absolute(path).string();
  void* const library = dlopen(full.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) registry.refuse(fmt::format("cannot be loaded ({}) build it as examples/user_effect shows", dlerror()));
  auto const abi = reinterpret_cast<int (*)()>(dlsym(library, "layerloop_plugin_abi"));
  auto const enter = reinterpret_cast<void (*)(EffectRegistry&)>(dlsym(library, "layerloop_register"));
  if (!abi || !enter)
    registry.refuse("is no library of effects (it exports no layerloop_plugin_abi and layerloop_register)");
  if (abi() != user_effect_abi)
    registry.refuse(fmt::format("was built for version {} of core/user_effect.hpp (this program has {}) build it anew",
                                abi(), user_effect_abi));
  loaded().plugins.push_back({std::filesystem::path(path).filename().string(), sha256_of(full)});
  enter(registry);
}

std::vector<Plugin> const& plugins() { return loaded().plugins; }

std::string plugin_note() {
  std::string note;
  for (Plugin const& plugin : plugins()) note += fmt::format(" + {} (sha256 {})", plugin.path, plugin.sha256);
  return note;
}

std::vector<ActiveUserEffect> active_user_effects(std::map<std::string, EffectSettings> const& settings) {
  std::vector<ActiveUserEffect> active;
  for (std::size_t e = 0; e < loaded().rows.size(); ++e) {
    auto const own = settings.find(loaded().rows[e].name);
    if (own == settings.end() || !own->second.enabled || own->second.strength == 0) continue;
    active.push_back({loaded().effects[e].get(), {own->second.strength, own->second.parameters}});
  }
  return active;
}

std::vector<Effect> const& user_effects() { return loaded().rows; }

UserEffect const& user_effect(std::string const& name) {
  auto const row = std::ranges::find(loaded().rows, name, &Effect::name);
  if (row == loaded().rows.end()) throw std::out_of_range("no library brings an effect " + name);
  return *loaded().effects[static_cast<std::size_t>(row - loaded().rows.begin())];
}

}  // namespace layerloop
