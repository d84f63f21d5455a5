#pragma once
#include <cstddef>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/effect_catalogue.hpp"
#include "core/vec3.hpp"

// What an effect of the user's is made of: one C++ file that is compiled to a shared library and loaded with
// --plugin lib.so (examples/user_effect). At strength 0 an effect is not called at all.
namespace layerloop {

/// Raised whenever something in this header changes. A library that was built for another one is refused.
inline constexpr int user_effect_abi = 1;

/// Strength and parameters of an effect, as the case gives them [SI].
struct EffectValues {
  double strength = 0;
  std::map<std::string, double> parameters = {};
  double operator()(std::string const& name) const { return parameters.at(name); }
};

/// Base of all; an effect derives from one or more of those below.
class UserEffect {
 public:
  virtual ~UserEffect() = default;
};

/// Pairs of grains that touch, some dozens at a time.
struct TouchingPairs {
  std::size_t count = 0;
  double const* overlap = nullptr;           ///< [m]
  double const* reduced_radius = nullptr;    ///< [m], 1/R = 1/R_1 + 1/R_2
  double const* separation_speed = nullptr;  ///< along the line of centres; negative: they approach [m/s]
};

/// Adds attraction between grains that touch [N]; negative: they repel. It counts with cohesion in Coulomb's bound.
/// Called from several threads at a time.
class PairAttraction : public virtual UserEffect {
 public:
  virtual void add(TouchingPairs const& pairs, EffectValues const& values, double* attraction) const = 0;
};

/// Changes properties of the metal in the heat equation.
class MetalProperties : public virtual UserEffect {
 public:
  /// \param k  [W/(m K)] at T [K]
  virtual double conductivity(double k, double /*T*/, EffectValues const&) const { return k; }
  /// \param c  [J/(kg K)] at T [K]
  virtual double specific_heat(double c, double /*T*/, EffectValues const&) const { return c; }
};

/// The beam while it stays at one place.
struct BeamMoment {
  double time = 0;                                      ///< that the beam has been on in this layer [s]
  double incident = 0;                                  ///< [W]
  double absorbed = 0;                                  ///< [W]
  double speed = 0;                                     ///< scan speed [m/s]
  Vec3 position = Vec3::Zero(), along = Vec3::UnitX();  ///< [m]; direction of travel
};

/// Changes the power that the metal absorbs.
class AbsorbedPowerEffect : public virtual UserEffect {
 public:
  /// \return [W], from 0 to beam.incident
  virtual double absorbed(BeamMoment const& beam, EffectValues const& values) const = 0;
};

/// Changes what an instrument reads of a quantity, for the class `instrument`.
class ReadingEffect : public virtual UserEffect {
 public:
  virtual std::vector<std::string> quantities() const = 0;                     ///< "pool.depth"
  virtual double reading(double value, EffectValues const& values) const = 0;  ///< [SI]
};

/// Takes what a library brings.
class EffectRegistry {
 public:
  virtual ~EffectRegistry() = default;
  /// \param row  name, stage, class, bounds and parameters, as in the catalogue; off by default
  virtual void add(Effect row, std::shared_ptr<UserEffect const> effect) = 0;
};

/// What a library exports: `extern "C" int layerloop_plugin_abi()` gives user_effect_abi, and `extern "C" void
/// layerloop_register(layerloop::EffectRegistry&)` adds its effects. This macro writes the first.
#define LAYERLOOP_PLUGIN \
  extern "C" int layerloop_plugin_abi() { return layerloop::user_effect_abi; }

/// A library that is loaded.
struct Plugin {
  std::string path;
  std::string sha256;  ///< of the file
};

/// Loads a library and joins its effects to the catalogue. \pre nothing has asked for the catalogue yet
/// \throws InputError  it cannot be loaded, was built for another header, or brings an effect whose name is taken
void load_plugin(std::string const& path);
std::vector<Plugin> const& plugins();

/// " + libmoisture.so (sha256 0f3a...)" for every library; empty without.
std::string plugin_note();

/// An effect of a library that is on in a case.
struct ActiveUserEffect {
  UserEffect const* effect;
  EffectValues values;
};
std::vector<ActiveUserEffect> active_user_effects(std::map<std::string, EffectSettings> const& settings);

/// The effects of libraries among the rows of the catalogue.
std::vector<Effect> const& user_effects();
/// \throws std::out_of_range  no library brings it
UserEffect const& user_effect(std::string const& name);

}  // namespace layerloop
