#pragma once
#include <array>
#include <span>
#include <vector>

#include "raytrace/beam.hpp"
#include "raytrace/surface.hpp"

namespace layerloop::raytrace {

/// What is followed of the light along a path.
enum class Polarisation {
  averaged,  ///< unpolarised afresh at every hit: within 0.002 on powder, 0.009 off in a V-groove of steel
  tracked    ///< as polarised as the beam when it arrives, then the field is followed from hit to hit
};

/// Whether derivatives with respect to the refractive indices are carried along.
enum class Slopes { without, with };

/// One hit, as far as light is concerned.
struct Reflection {
  std::size_t material;
  Vec3 const& in;      ///< direction of the ray, unit length
  Vec3 const& normal;  ///< of the surface, outward
  Vec3 const& out;     ///< mirrored direction
};

/// Power that one ray still carries under several optical sets, as shares of what it started with; its polarisation is
/// forgotten between hits. One object serves many rays one after another, so that no ray allocates.
class AveragedLight {
 public:
  AveragedLight(std::span<OpticalSet const> sets, Slopes slopes);

  void start(Beam const& beam, Vec3 const& direction);
  /// Splits the power of every set into what the surface absorbs and what goes on.
  void reflect(Reflection const& hit);
  /// The reflected light goes to `out` with no memory of its polarisation (diffuse reflection).
  void scatter(Vec3 const& /*out*/) {}
  /// Takes a set off the path.
  void end(std::size_t set);

  double power(std::size_t set) const { return power_[set]; }
  double absorbed(std::size_t set) const { return absorbed_[set]; }  ///< at the last hit
  /// Derivative of power(set) with respect to the index of a material.
  IndexSlope slope(std::size_t set, std::size_t material) const { return slope_[set * materials_ + material]; }

 private:
  std::span<OpticalSet const> sets_;
  std::size_t materials_;
  std::vector<double> power_, absorbed_;
  std::vector<IndexSlope> slope_;  // shape (sets, materials); empty without slopes
};

/// The same with the complex field followed from hit to hit, as two incoherent parts (unpolarised light) or one.
class TrackedLight {
 public:
  TrackedLight(std::span<OpticalSet const> sets, Slopes slopes);

  void start(Beam const& beam, Vec3 const& direction);
  void reflect(Reflection const& hit);
  void scatter(Vec3 const& out);
  void end(std::size_t set);

  double power(std::size_t set) const { return power_[set]; }
  double absorbed(std::size_t set) const { return absorbed_[set]; }
  IndexSlope slope(std::size_t set, std::size_t material) const;

 private:
  using Field = Eigen::Vector3cd;
  static constexpr std::size_t parts = 2;

  std::span<OpticalSet const> sets_;
  std::size_t materials_;
  std::vector<double> power_, absorbed_;
  std::vector<Field> field_;  // shape (sets, parts)
  std::vector<Field> slope_;  // d field / d index, shape (sets, parts, materials); empty without slopes
};

}  // namespace layerloop::raytrace
