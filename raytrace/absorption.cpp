#include "raytrace/absorption.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/statistics.hpp"
#include "raytrace/ray_loop.hpp"

namespace layerloop::raytrace {
namespace {

/// Pixels over the tile where the scene is periodic, over everything in it where it is open.
AreaMap map_frame(BedScene const& scene, double spacing) {
  AreaMap map;
  map.spacing = spacing;
  if (spacing == 0) return map;
  std::array<double, 2> from, extent;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    auto const a = static_cast<Eigen::Index>(axis);
    bool const periodic = scene.period()[axis] > 0;
    from[axis] = periodic ? 0.0 : scene.lower()[a];
    extent[axis] = periodic ? scene.period()[axis] : scene.upper()[a] - scene.lower()[a];
  }
  auto const pixels = [&](double length) { return std::max(1.0, std::ceil(length / spacing - 1e-9)); };
  double const nx = pixels(extent[0]), ny = pixels(extent[1]);
  if (!(spacing > 0 && nx * ny <= 1e7)) {
    throw InputError(
        fmt::format("a map with pixels of {:g} m cannot be made of {:g} x {:g} m (1 to 1e7 pixels): "
                    "choose another spacing",
                    spacing, extent[0], extent[1]));
  }
  map.x0 = from[0];
  map.y0 = from[1];
  map.nx = static_cast<std::int32_t>(nx);
  map.ny = static_cast<std::int32_t>(ny);
  return map;
}

Places places_of(BedScene const& scene, AbsorptionSettings const& settings) {
  Places places{.grains = true,
                .grid = settings.grid ? &*settings.grid : nullptr,
                .map = map_frame(scene, settings.map_spacing),
                .bottom = scene.lower().z(),
                .top = scene.upper().z()};
  if (settings.depth_range) {
    places.bottom = (*settings.depth_range)[0];
    places.top = (*settings.depth_range)[1];
    if (!(places.top > places.bottom)) {
      throw InputError(
          fmt::format("a depth profile from {:g} to {:g} m has no layers (its top must lie above its "
                      "bottom): check its range",
                      places.bottom, places.top));
    }
  } else if (!(places.top > places.bottom)) {  // a flat plate
    places.top = places.bottom + 1e-6;
  }
  return places;
}

void check_settings(AbsorptionSettings const& settings) {
  if (!(settings.replicates >= 2 && settings.rays >= 1 && settings.max_rays >= settings.rays)) {
    throw InputError(fmt::format(
        "{} to {} rays in {} replicates cannot be traced (the standard error needs 2 replicates, and the most cannot "
        "be below the least): raise optics.rays",
        settings.rays, settings.max_rays, settings.replicates));
  }
  if (!(settings.target_standard_error >= 0 && settings.depth_bins >= 0)) {
    throw InputError(
        fmt::format("a target of {:g} for the standard error and {} layers of depth make no sense (both "
                    "are zero or positive): check --target-se",
                    settings.target_standard_error, settings.depth_bins));
  }
}

SetAbsorption of_set(RayTally const& tally, std::size_t set, Slopes slopes) {
  TallyLayout const& at = tally.layout;
  SetAbsorption result;
  auto const [absorptivity, error] = tally.absorptivity(set);
  result.absorptivity = absorptivity;
  result.standard_error = error;
  result.half_width = error * student_t_quantile(0.975, static_cast<double>(tally.replicate.size() - 1));
  auto const put = [&](std::size_t figure, std::vector<double>& values, std::vector<double>& errors) {
    auto const [value, its_error] = tally.estimate(figure);
    values.push_back(value);
    errors.push_back(its_error);
  };
  for (std::size_t m = 0; m < at.materials; ++m) {
    put(at.absorbed(set, m), result.by_material, result.by_material_error);
    if (slopes == Slopes::without) continue;
    put(at.slope_n(set, m), result.d_n, result.d_n_error);
    put(at.slope_k(set, m), result.d_k, result.d_k_error);
  }
  auto const [substrate, substrate_error] = tally.estimate(at.substrate(set));
  result.substrate = substrate;
  result.substrate_error = substrate_error;
  result.escaped = tally.estimate(at.escaped(set)).value;
  result.residual = tally.estimate(at.residual(set)).value;
  return result;
}

void sort_by_place(RayTally const& tally, Places const& places, Absorption& result) {
  double const rays = tally.rays();
  for (CompensatedSum const& grain : tally.grain) result.grain_share.push_back(grain.value() / rays);
  result.substrate_share = result.sets[0].substrate;

  std::size_t const bins = tally.layout.depth_bins;
  double const thickness = bins > 0 ? (places.top - places.bottom) / static_cast<double>(bins) : 0.0;
  for (std::size_t b = 0; b < bins; ++b) {
    auto const [fraction, error] = tally.estimate(tally.layout.depth(b));
    result.depth_profile.push_back({places.bottom + (static_cast<double>(b) + 0.5) * thickness, fraction, error});
  }

  result.map = result.map_error = places.map;
  double const pixel_area = places.map.spacing * places.map.spacing;
  for (std::size_t p = 0; !tally.map.empty() && p < tally.map[0].size(); ++p) {
    auto const [share, error] = tally.pixel(p);
    result.map.values.push_back(share / pixel_area);
    result.map_error.values.push_back(error / pixel_area);
  }
  result.outside_map = tally.outside_map.value() / rays;

  for (auto const& [cell, sum] : tally.cells()) {
    result.cell.push_back(cell);
    result.cell_share.push_back(sum / rays);
  }
  result.outside_grid = tally.outside_grid.value() / rays;
}

/// Largest difference between the total and what its parts add up to.
double ledger_error(Absorption const& result, AbsorptionSettings const& settings) {
  double worst = 0;
  auto const compare = [&](double total, auto const& parts, double rest) {
    CompensatedSum sum;
    sum.add(rest);
    for (double const part : parts) sum.add(part);
    double const error = std::abs(sum.value() - total);
    if (std::isnan(error) || error > worst) worst = error;
  };
  for (SetAbsorption const& set : result.sets) {
    compare(1, std::array{set.absorptivity, set.escaped, set.residual}, 0);
    compare(set.absorptivity, set.by_material, 0);
  }
  double const total = result.sets[0].absorptivity;
  compare(total, result.grain_share, result.substrate_share);
  if (settings.grid) compare(total, result.cell_share, result.outside_grid);
  std::vector<double> layers;
  for (DepthLayer const& layer : result.depth_profile) layers.push_back(layer.fraction);
  if (settings.depth_bins > 0) compare(total, layers, 0);
  return worst;
}

void check_result(Absorption const& result, BedScene const& scene, AbsorptionSettings const& settings) {
  if (double const error = ledger_error(result, settings); !(error < 1e-12)) {
    SetAbsorption const& set = result.sets[0];
    throw PhysicsError(
        fmt::format("the ledger of the trace does not close (absorbed {:g}, escaped {:g}, residual {:g} of 1, error "
                    "{:g}); look for "
                    "coordinates or refractive indices that are not numbers",
                    set.absorptivity, set.escaped, set.residual, error));
  }
  if (result.mean_bounces == 0) {
    throw PhysicsError(
        fmt::format("no ray of the beam met anything (bed and substrate span x = {:g} to {:g} m, y = "
                    "{:g} to {:g} m): check where the beam falls",
                    scene.lower().x(), scene.upper().x(), scene.lower().y(), scene.upper().y()));
  }
}

}  // namespace

Absorption absorb(BedScene const& scene, Beam const& beam, std::span<OpticalSet const> sets,
                  std::int32_t substrate_material, AbsorptionSettings const& settings, Communicator const* ranks) {
  check_settings(settings);
  RayProblem const problem{.scene = scene,
                           .beam = beam,
                           .sets = sets,
                           .substrate_material = substrate_material,
                           .polarisation = settings.polarisation,
                           .slopes = settings.derivatives ? Slopes::with : Slopes::without,
                           .diffuse_share = settings.diffuse_share,
                           .cut_off = settings.cut_off,
                           .max_bounces = settings.max_bounces,
                           .seed = settings.seed,
                           .id = settings.id,
                           .places = places_of(scene, settings)};
  check_problem(problem);

  TallyLayout const layout{sets.size(), sets[0].surface.size(), static_cast<std::size_t>(settings.depth_bins)};
  RayTally tally(layout, problem.places, static_cast<std::size_t>(scene.grains()), settings.replicates);
  auto const per_replicate = [&](std::int64_t rays) { return (rays + settings.replicates - 1) / settings.replicates; };
  trace_rays(problem, per_replicate(settings.rays), tally, ranks);
  double const target = settings.target_standard_error;
  auto const precise = [&] {
    for (std::size_t k = 0; target > 0 && k < sets.size(); ++k) {
      if (!(tally.absorptivity(k).error <= target)) return false;
    }
    return true;
  };
  while (!precise() && tally.replicate_rays < per_replicate(settings.max_rays)) {
    trace_rays(problem, std::min(2 * tally.replicate_rays, per_replicate(settings.max_rays)), tally, ranks);
  }

  Absorption result;
  result.rays = tally.replicate_rays * settings.replicates;
  result.replicates = settings.replicates;
  result.mean_bounces = tally.estimate(layout.hits()).value;
  result.target_reached = precise();
  for (std::size_t k = 0; k < sets.size(); ++k) result.sets.push_back(of_set(tally, k, problem.slopes));
  sort_by_place(tally, problem.places, result);
  check_result(result, scene, settings);
  return result;
}

}  // namespace layerloop::raytrace
