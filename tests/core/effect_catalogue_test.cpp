#include "core/effect_catalogue.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

namespace layerloop {
namespace {

/// What a search over effects relies on: one name each, a place in the program, numbers that mean something.
TEST(EffectCatalogue, IsSound) {
  std::set<std::string> names;
  for (Effect const& effect : effect_catalogue()) {
    EXPECT_TRUE(names.insert(effect.name).second) << effect.name << " twice";
    EXPECT_TRUE(std::filesystem::exists(std::string(LAYERLOOP_SOURCE_DIR) + "/" + effect.file)) << effect.file;
    EXPECT_FALSE(effect.source.empty()) << effect.name;
    EXPECT_EQ(effect.strength().null_value, 0.0);
    std::vector<EffectParameter> numbers = effect.parameters;
    numbers.push_back(effect.strength());
    for (EffectParameter const& p : numbers) {
      std::string const name = effect.name + "." + p.name;
      EXPECT_GT(p.prior_scale, 0) << name;
      EXPECT_LE(p.prior_scale, p.range.max - p.range.min) << name;
      EXPECT_TRUE(!p.null_value || p.range.contains(*p.null_value)) << name;
      EXPECT_TRUE(p.sign == EffectSign::either || p.range.min >= 0) << name;
      EXPECT_TRUE(p.name == "strength" || p.range.contains(effect_parameter({}, effect.name, p.name))) << name;
    }
  }
}

TEST(EffectCatalogue, SettingsComeBeforeDefaults) {
  EXPECT_EQ(effect_parameter({}, "surface_losses", "convection"), 20);
  std::map<std::string, EffectSettings> const given{{"surface_losses", {true, 1, {{"convection", 35}}}}};
  EXPECT_EQ(effect_parameter(given, "surface_losses", "convection"), 35);
  EXPECT_THROW(effect_parameter({}, "surface_losses", "colour"), std::out_of_range);
}

}  // namespace
}  // namespace layerloop
