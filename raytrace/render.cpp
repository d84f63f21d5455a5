#include "raytrace/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"

namespace layerloop::raytrace {
namespace {

using Light = Eigen::Array3d;  ///< linear red, green, blue

constexpr double key_strength = 0.78, sky_strength = 0.46, mirror_strength = 0.26;
constexpr double highlight_strength = 0.20, highlight_exponent = 40;
constexpr double key_softness = 0.06;  // radius of the key light as seen from the scene [rad]
Light const key_tint{1.03, 1.0, 0.94}, sky_tint{0.94, 0.99, 1.06};  // warm lamp, cool sky
constexpr double crease_cosine = 0.75;  // surfaces that meet at a sharper angle keep their edge

Light light_of(Colour const& colour) {
  auto const c = linear_light(colour);
  return {c[0], c[1], c[2]};
}

/// The scene with everything that shading needs, worked out once.
struct Stage {
  BedScene const& scene;
  std::vector<Light> grain, vertex;
  Light powder, substrate, background;
  std::vector<Vec3> vertex_normal;
  Vec3 key;            ///< towards the key light
  double shade_reach;  ///< how far ambient shade looks [m]
  double shadow_reach;
  int ambient_rays;
};

std::vector<Light> lights_of(std::vector<Colour> const& colours) {
  std::vector<Light> lights;
  for (Colour const& c : colours) lights.push_back(light_of(c));
  return lights;
}

/// Area-weighted mean of the triangles around each vertex.
std::vector<Vec3> vertex_normals(TriangleSurface const& surface) {
  std::vector<Vec3> normals(surface.vertices.size(), Vec3::Zero());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Vec3 const twice_area =
        (surface.corner(t, 1) - surface.corner(t, 0)).cross(surface.corner(t, 2) - surface.corner(t, 0));
    for (std::int32_t const corner : surface.triangles[t]) normals[static_cast<std::size_t>(corner)] += twice_area;
  }
  for (Vec3& n : normals) n = n.normalized();
  return normals;
}

Stage make_stage(BedScene const& scene, Camera const& camera, Paint const& paint, RenderSettings const& settings) {
  if ((!paint.grains.empty() && paint.grains.size() != static_cast<std::size_t>(scene.grains())) ||
      (!paint.substrate_vertices.empty() && paint.substrate_vertices.size() != scene.substrate().vertices.size())) {
    throw InputError(fmt::format(
        "{} grain colours and {} vertex colours do not fit a scene of {} grains and {} vertices: give one "
        "each, or none",
        paint.grains.size(), paint.substrate_vertices.size(), scene.grains(), scene.substrate().vertices.size()));
  }
  double mean_radius = 0;
  for (std::int32_t row = 0; row < scene.grains(); ++row) mean_radius += scene.radius(row) / scene.grains();
  double const diagonal = (scene.upper() - scene.lower()).norm();
  Vec3 const away = Vec3(-camera.right.y(), camera.right.x(), 0);  // level, from the camera into the picture
  return {.scene = scene,
          .grain = lights_of(paint.grains),
          .vertex = lights_of(paint.substrate_vertices),
          .powder = light_of(paint.powder),
          .substrate = light_of(paint.substrate),
          .background = light_of(paint.background),
          .vertex_normal = vertex_normals(scene.substrate()),
          .key = (-0.55 * camera.right + 0.10 * away + Vec3::UnitZ()).normalized(),
          .shade_reach = mean_radius > 0 ? 4 * mean_radius : 0.03 * diagonal,
          .shadow_reach = diagonal,
          .ambient_rays = settings.ambient_rays};
}

struct Surface {
  Light colour;
  Vec3 normal;  ///< for shading: smooth over the substrate
};

Surface surface_at(Stage const& stage, Hit const& hit) {
  auto const row = static_cast<std::size_t>(hit.row);
  if (hit.target == Target::grain) return {stage.grain.empty() ? stage.powder : stage.grain[row], hit.normal};

  TriangleSurface const& mesh = stage.scene.substrate();
  Vec3 const &a = mesh.corner(row, 0), &b = mesh.corner(row, 1), &c = mesh.corner(row, 2);
  double const area = (b - a).cross(c - a).dot(hit.normal);
  double const share_b = (hit.point - a).cross(c - a).dot(hit.normal) / area;
  double const share_c = (b - a).cross(hit.point - a).dot(hit.normal) / area;
  std::array<double, 3> const share{1 - share_b - share_c, share_b, share_c};
  Surface surface{stage.vertex.empty() ? stage.substrate : Light::Zero(), Vec3::Zero()};
  for (std::size_t corner = 0; corner < 3; ++corner) {
    auto const v = static_cast<std::size_t>(mesh.triangles[row][corner]);
    bool const smooth = stage.vertex_normal[v].dot(hit.normal) > crease_cosine;
    surface.normal += share[corner] * (smooth ? stage.vertex_normal[v] : hit.normal);
    if (!stage.vertex.empty()) surface.colour += share[corner] * stage.vertex[v];
  }
  surface.normal.normalize();
  return surface;
}

/// Share of the sky that is seen from a point, by cosine-weighted directions. They are the same for every pixel (faint
/// contours please the eye more than noise) and different for the samples of one.
double open_sky(Stage const& stage, Hit const& hit, int sample) {
  Vec3 const side = hit.normal.unitOrthogonal(), other = hit.normal.cross(side);
  double open = 0;
  for (int i = 0; i < stage.ambient_rays; ++i) {
    double const index = sample * stage.ambient_rays + i;
    double const u = (i + std::fmod(0.5 + 0.5698402909980532 * index, 1.0)) / stage.ambient_rays;
    double const angle = 2 * std::numbers::pi * std::fmod(0.7548776662466927 * index, 1.0);
    double const r = std::sqrt(u);
    Vec3 const direction = r * std::cos(angle) * side + r * std::sin(angle) * other + std::sqrt(1 - u) * hit.normal;
    open += !stage.scene.is_blocked({hit.point, direction}, stage.shade_reach);
  }
  return stage.ambient_rays > 0 ? open / stage.ambient_rays : 1.0;
}

Light shade(Stage const& stage, Ray const& ray, int sample) {
  Hit const hit = stage.scene.first_hit_in_tile(ray);
  if (hit.target == Target::nothing) return stage.background;

  Surface const surface = surface_at(stage, hit);
  double const turn = 2.399963 * sample;  // golden angle
  Vec3 const aside = stage.key.unitOrthogonal(), across = stage.key.cross(aside);
  Vec3 const key = (stage.key + key_softness * (std::cos(turn) * aside + std::sin(turn) * across)).normalized();
  double const facing = std::max(surface.normal.dot(key), 0.0);
  bool const lit =
      facing > 0 && hit.normal.dot(key) > 0 && !stage.scene.is_blocked({hit.point, key}, stage.shadow_reach);

  Vec3 const mirrored = ray.direction - 2 * ray.direction.dot(surface.normal) * surface.normal;
  double const sky = sky_strength * (0.6 + 0.4 * surface.normal.z()) + mirror_strength * std::max(mirrored.z(), 0.0);
  Light light =
      surface.colour * (sky * open_sky(stage, hit, sample) * sky_tint + (lit ? key_strength * facing : 0.0) * key_tint);
  if (lit) light += highlight_strength * std::pow(std::max(mirrored.dot(key), 0.0), highlight_exponent);
  return light;
}

}  // namespace

Image render(BedScene const& scene, Camera const& camera, Paint const& paint, RenderSettings const& settings) {
  Stage const stage = make_stage(scene, camera, paint, settings);
  Image image{settings.width, settings.height, {}};
  image.rgb.resize(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  int const n = settings.samples;

#pragma omp parallel for schedule(dynamic)
  for (std::int32_t row = 0; row < image.height; ++row) {
    for (std::int32_t column = 0; column < image.width; ++column) {
      Light light = Light::Zero();
      for (int s = 0; s < n * n; ++s) {
        double const u = 2 * (column + (s % n + 0.5) / n) / image.width - 1;
        double const v = 1 - 2 * (row + (s / n + 0.5) / n) / image.height;
        // Clipped before the mean: smooth edges on highlights too.
        light += shade(stage, camera.ray(u, v), s).min(1.0);
      }
      Colour const colour = screen_colour({light[0] / (n * n), light[1] / (n * n), light[2] / (n * n)});
      std::copy(colour.begin(), colour.end(), image.rgb.begin() + 3 * (std::ptrdiff_t{row} * image.width + column));
    }
  }
  return image;
}

}  // namespace layerloop::raytrace
