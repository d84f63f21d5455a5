#pragma once
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/powder_bed.hpp"
#include "core/random.hpp"
#include "core/statistics.hpp"
#include "core/triangle_surface.hpp"
#include "raytrace/absorption.hpp"
#include "raytrace/trace.hpp"

namespace layerloop::raytrace {

/// n + ik near 1 um: Boley, Khairallah & Rubenchik, Appl. Opt. 54 (2015) 2477.
inline constexpr std::complex<double> stainless_steel{3.27, 4.48};
inline constexpr std::complex<double> silver{0.23, 7.09};
/// Reflects nothing at any angle.
inline constexpr std::complex<double> black{1.0, 0.0};

/// Two triangles at height z, normal up.
inline TriangleSurface flat_floor(double x0, double x1, double y0, double y1, double z) {
  return {{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

inline void add_grain(PowderBed& bed, double x, double y, double z, double radius) {
  bed.add(static_cast<std::int64_t>(bed.size()), {x, y, z}, radius, 0);
}

/// Close-packed hexagonal layers (AB stack) of touching spheres of diameter 1 on z = 0, in a tile of 1 x sqrt(3).
struct Lattice {
  PowderBed bed;
  std::array<double, 2> period;
};
inline Lattice hexagonal_layers(int layers) {
  double const root3 = std::sqrt(3.0);
  Lattice lattice{{}, {1, root3}};
  for (int l = 0; l < layers; ++l) {
    double const y = l % 2 * root3 / 3, z = 0.5 + l * std::sqrt(2.0 / 3.0);
    add_grain(lattice.bed, 0.25 + 0.0, 0.2 + y, z, 0.5);
    add_grain(lattice.bed, 0.25 + 0.5, std::fmod(0.2 + y + root3 / 2, root3), z, 0.5);
  }
  return lattice;
}

/// Simple cubic, edge 1, seen along a cube edge.
inline Lattice simple_cubic(int layers) {
  Lattice lattice{{}, {1, 1}};
  for (int l = 0; l < layers; ++l) add_grain(lattice.bed, 0.3, 0.7, 0.5 + l, 0.5);
  return lattice;
}

/// Face-centred cubic, seen along a cube edge; layers are half a cube edge apart.
inline Lattice face_centred_cubic(int layers) {
  double const edge = std::sqrt(2.0);
  Lattice lattice{{}, {edge, edge}};
  for (int l = 0; l < layers; ++l) {
    double const z = 0.5 + l * edge / 2, shift = l % 2 * edge / 2;
    add_grain(lattice.bed, 0.25 * edge, std::fmod(0.25 * edge + shift, edge), z, 0.5);
    add_grain(lattice.bed, 0.75 * edge, std::fmod(0.75 * edge + shift, edge), z, 0.5);
  }
  return lattice;
}

/// Grains of four sizes at random places without overlap over a floor at z = 0; periodic in y with `width`, x from 0 to
/// `length`.
inline PowderBed random_bed(double length, double width, double height, int tries) {
  std::array<double, 4> const radii{21e-6, 14e-6, 10.5e-6, 6.5e-6};
  PowderBed bed;
  for (int t = 0; t < tries; ++t) {
    auto const u = uniform4(7, RandomStream::grain_position, static_cast<std::uint64_t>(t));
    double const r = radii[static_cast<std::size_t>(4 * t / tries)];
    Vec3 const p(r + u[0] * (length - 2 * r), u[1] * width, r + u[2] * (height - 2 * r));
    bool free = true;
    for (std::size_t i = 0; i < bed.size() && free; ++i) {
      Vec3 d = p - bed.position(i);
      d.y() -= width * std::round(d.y() / width);
      free = d.norm() > r + bed.radius[i];
    }
    if (free) add_grain(bed, p.x(), p.y(), p.z(), r);
  }
  return bed;
}

/// Uniform light of 1 W over the whole tile.
inline Beam uniform_light(std::array<double, 2> const& period) {
  return {.centre = {0.5 * period[0], 0.5 * period[1], 0},
          .power = 1,
          .profile = BeamProfile::uniform,
          .size_x = period[0],
          .size_y = period[1]};
}

/// One cell around everything: what falls in it is not asked for.
inline VoxelGrid one_cell(BedScene const& scene) {
  double const edge = 2 * (scene.upper() - scene.lower()).norm();
  return {0.5 * (scene.lower() + scene.upper()) - Vec3::Constant(0.5 * edge), edge, {1, 1, 1}};
}

/// One material for everything.
inline OpticalSet bare(std::complex<double> metal) { return {"", {{.refractive_index = metal}}, 0}; }
inline OpticalSet grey(double absorptivity) {
  return {"", {{.refractive_index = 1, .grey_reflectance = 1 - absorptivity}}, 0};
}

inline AbsorbedPower trace_uniform(BedScene const& scene, std::complex<double> metal, std::int64_t rays) {
  std::array const metals{metal};
  return trace(scene, uniform_light(scene.period()), metals, 0, one_cell(scene), {.rays = rays});
}

}  // namespace layerloop::raytrace
