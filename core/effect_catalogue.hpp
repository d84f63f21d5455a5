#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/case_schema.hpp"

namespace layerloop {

/// Where in the layer loop an effect acts.
enum class EffectStage { dem, laser, heat, solid };

/// What kind of cause it is: the world, a number of the model, its discretisation, or the measuring.
enum class EffectClass { physics, calibration, numerics, instrument };

/// Which way a parameter may depart from its null value.
enum class EffectSign { positive, either };

/// One number of an effect. Shown and checked like any key of the case file.
struct EffectParameter {
  std::string name;
  Dimension dimension = Dimension::none;
  Range range;             ///< SI
  std::string fallback;    ///< default as one would write it
  double prior_scale = 0;  ///< how far from the default it may well be: one standard deviation beforehand [SI]
  std::string sentence;
  std::optional<double> null_value = {};  ///< at which it does nothing; none: only the strength switches it off
  EffectSign sign = EffectSign::positive;
};

/// Something that a user may one day find missing. Every effect has a strength, at whose null value, 0, the model is
/// bit for bit the one without it.
struct Effect {
  std::string name;
  EffectStage stage;
  EffectClass kind = EffectClass::physics;
  std::string enabled;          ///< default, as one would write it
  double largest_strength = 1;  ///< beyond it the model would lose its meaning
  double prior_scale = 1;       ///< of the strength
  std::string sentence;         ///< what it is
  std::string source;           ///< paper or formula
  std::string file;             ///< that implements it
  std::vector<EffectParameter> parameters = {};

  EffectParameter strength() const;
};

/// Every effect that the program knows, by stage; then those of libraries that were loaded before the first call.
std::vector<Effect> const& effect_catalogue();
bool is_built_in(std::string const& name);

/// Value of an effect's parameter, its default where the settings do not name it [SI].
/// \throws std::out_of_range  the effect has no such parameter: a bug
double effect_parameter(std::map<std::string, EffectSettings> const& effects, std::string const& effect,
                        std::string const& parameter);

}  // namespace layerloop
