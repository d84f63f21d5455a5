#pragma once
#include <cstdint>
#include <vector>

#include "core/png_image.hpp"
#include "raytrace/bed_scene.hpp"
#include "raytrace/camera.hpp"
#include "raytrace/colour.hpp"

namespace layerloop::raytrace {

/// Colours of what is shown.
struct Paint {
  std::vector<Colour> grains{};              ///< one a grain; empty: all like `powder`
  std::vector<Colour> substrate_vertices{};  ///< one a vertex, blended in between; empty: all like `substrate`
  Colour powder{186, 189, 194};
  Colour substrate{168, 174, 183};
  Colour background{250, 251, 252};
};

struct RenderSettings {
  std::int32_t width = 900, height = 600;  ///< [pixels]
  std::int32_t samples = 2;                ///< per pixel and direction: 2 is four rays a pixel
  std::int32_t ambient_rays = 8;           ///< per sample, for the soft shade in gaps
};

/// Picture of the very scene that was traced: a key light with shadows, a sky that is shaded in gaps (ambient
/// occlusion), soft highlights. The same picture to the bit for any number of threads. \throws InputError  paint does
/// not fit the scene
Image render(BedScene const& scene, Camera const& camera, Paint const& paint, RenderSettings const& settings = {});

}  // namespace layerloop::raytrace
