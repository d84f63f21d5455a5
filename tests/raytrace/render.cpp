#include "raytrace/render.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include "core/error.hpp"
#include "scenes.hpp"

namespace layerloop::raytrace {
namespace {

Colour pixel(Image const& image, std::int32_t x, std::int32_t y) {
  auto const at = 3 * static_cast<std::size_t>(x + image.width * y);
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

int brightness(Colour const& c) { return c[0] + c[1] + c[2]; }

PowderBed one_grain() {
  PowderBed bed;
  add_grain(bed, 0, 0, 1, 1);
  return bed;
}

TEST(Camera, FrameHoldsTheWholeBoxAndTouchesIt) {
  Vec3 const lower(-1, 2, 0), upper(3, 3, 0.5);
  for (ViewDirection const direction : {oblique, from_above, ViewDirection{-90, 0}, ViewDirection{20, 60}}) {
    for (Projection const projection : {Projection::orthographic, Projection::perspective}) {
      Camera const camera = fit_camera(lower, upper, direction, 1.5, projection);
      double widest = 0;
      for (int c = 0; c < 8; ++c) {
        Vec3 const corner(c & 1 ? upper.x() : lower.x(), c & 2 ? upper.y() : lower.y(), c & 4 ? upper.z() : lower.z());
        Vec3 const d = corner - camera.eye;
        double const depth = projection == Projection::perspective ? d.dot(camera.forward) : 1;
        EXPECT_GT(d.dot(camera.forward), 0);
        widest = std::max({widest, std::abs(d.dot(camera.right) / depth / camera.half_width),
                           std::abs(d.dot(camera.up) / depth / camera.half_height)});
      }
      EXPECT_LT(widest, 1);
      EXPECT_GT(widest, 0.93);
      EXPECT_NEAR(camera.right.cross(camera.up).dot(camera.forward), -1, 1e-12);
    }
  }
}

TEST(Camera, FromAboveXRunsToTheRightAndYUp) {
  Camera const camera = fit_camera({0, 0, 0}, {3, 2, 1}, from_above, 1.5);
  EXPECT_LT((camera.right - Vec3::UnitX()).norm(), 1e-12);
  EXPECT_LT((camera.up - Vec3::UnitY()).norm(), 1e-12);
}

TEST(Render, ASphereCoversItsShadow) {
  PowderBed const bed = one_grain();
  BedScene const scene(bed, {});
  Camera const camera = fit_camera({-1, -1, 0}, {1, 1, 2}, from_above, 1);
  Image const image = render(scene, camera, {}, {.width = 200, .height = 200, .samples = 1});
  int covered = 0;
  for (std::int32_t y = 0; y < 200; ++y) {
    for (std::int32_t x = 0; x < 200; ++x) covered += pixel(image, x, y) != Paint{}.background;
  }
  double const pixel_area = 4 * camera.half_width * camera.half_height / (200.0 * 200.0);
  EXPECT_NEAR(covered * pixel_area, std::numbers::pi, 0.01);
}

TEST(Render, TheKeyLightComesFromTheLeftAndCastsShadowsToTheRight) {
  PowderBed const bed = one_grain();
  BedScene const scene(bed, flat_floor(-4, 4, -4, 4, 0));
  Camera const camera = fit_camera({-3, -3, 0}, {3, 3, 2}, from_above, 1);
  Image const image = render(scene, camera, {}, {.width = 300, .height = 300});
  auto const at = [&](double x, double y) {
    return brightness(pixel(image, static_cast<std::int32_t>(150 * (1 + x / camera.half_width)),
                            static_cast<std::int32_t>(150 * (1 - y / camera.half_height))));
  };
  EXPECT_GT(at(-0.6, 0), at(0.6, 0) + 30) << "grain";
  EXPECT_GT(at(-1.3, 0), at(1.1, 0) + 30) << "floor beside it";
}

TEST(Render, PaintGoesWhereItBelongs) {
  PowderBed bed;
  add_grain(bed, -1, 0, 1, 0.8);
  add_grain(bed, 1, 0, 1, 0.8);
  BedScene const scene(bed, flat_floor(-3, 3, -3, 3, 0));
  Paint const paint{.grains = {{255, 0, 0}, {0, 0, 255}},
                    .substrate_vertices = {{0, 255, 0}, {0, 255, 0}, {0, 255, 0}, {0, 255, 0}}};
  Camera const camera = fit_camera({-2, -2, 0}, {2, 2, 2}, from_above, 1);
  Image const image = render(scene, camera, paint, {.width = 101, .height = 101});
  auto const x_of = [&](double x) { return static_cast<std::int32_t>(50.5 * (1 + x / camera.half_width)); };
  Colour const left = pixel(image, x_of(-1), 50), right = pixel(image, x_of(1), 50), floor = pixel(image, 50, 5);
  EXPECT_GT(left[0], 2 * left[2]);
  EXPECT_GT(right[2], 2 * right[0]);
  EXPECT_GT(floor[1], 2 * floor[0]);
  EXPECT_THROW(render(scene, camera, {.grains = {{1, 2, 3}}}), InputError);
}

TEST(Render, ThreadsDoNotChangeAPixel) {
  PowderBed const bed = random_bed(4e-4, 2e-4, 8e-5, 1000);
  BedScene const scene(bed, flat_floor(0, 4e-4, 0, 2e-4, 0), {0, 2e-4});
  Camera const camera = fit_camera(scene.lower(), scene.upper(), oblique, 1.5, Projection::perspective);
  auto const run = [&](int threads) {
    omp_set_num_threads(threads);
    return render(scene, camera, {}, {.width = 150, .height = 100}).rgb;
  };
  EXPECT_EQ(run(1), run(2));
  omp_set_num_threads(omp_get_num_procs());
}

TEST(Colour, MapRunsFromDarkToLightAndClamps) {
  EXPECT_EQ(viridis(0), (Colour{0x44, 0x01, 0x54}));
  EXPECT_EQ(viridis(1), (Colour{0xfd, 0xe7, 0x25}));
  EXPECT_EQ(viridis(7), viridis(1));
  double last = -1;
  for (int i = 0; i <= 100;
       ++i) {  // luminance (Rec. 709) must rise all the way, so that the map survives grey printing
    auto const light = linear_light(viridis(i / 100.0));
    double const luminance = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
    EXPECT_GT(luminance, last);
    last = luminance;
  }
  std::array const values{1.0, 2.0, 3.0};
  EXPECT_EQ(colour_by(values, 1, 3), (std::vector{viridis(0), viridis(0.5), viridis(1)}));
}

TEST(Colour, ScreenColoursSurviveTheWayToLightAndBack) {
  for (int v = 0; v < 256; ++v) {
    Colour const grey{static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(255 - v), 128};
    EXPECT_EQ(screen_colour(linear_light(grey)), grey);
  }
}

}  // namespace
}  // namespace layerloop::raytrace
