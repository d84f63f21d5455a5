#include "coupling/effects/denudation.hpp"

#include <algorithm>
#include <cmath>

#include "core/effect_catalogue.hpp"
#include "core/random.hpp"
#include "coupling/material_mass.hpp"

namespace layerloop::coupling {
namespace {

/// Distance of a point from a track seen from above, in a bed that is periodic in y [m].
double distance(Track const& track, double x, double y, double period) {
  Vec3 const along = track.end - track.begin;
  Vec3 away = Vec3(x, y, 0) - track.begin;
  away.y() -= period * std::round((away.y() - 0.5 * along.y()) / period);
  double const share = std::clamp(away.dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (away - share * along).head<2>().norm();
}

}  // namespace

Denuded denude(PowderBed& bed, std::vector<Track> const& tracks, Case const& checked, std::int32_t layer) {
  double const strength = checked.effect_strength("denudation");
  if (strength == 0) return {};
  double const reach = effect_parameter(checked.effects, "denudation", "width_factor") * checked.laser.spot_diameter;
  std::vector<char> keep(bed.size(), 1);
  for (std::size_t row = 0; row < bed.size(); ++row) {
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      double const chance = strength * (1 - distance(tracks[t], bed.x[row], bed.y[row], checked.machine.width) / reach);
      if (chance <= 0) continue;
      auto const draw = static_cast<std::uint32_t>(layer) << 16 | static_cast<std::uint32_t>(t);
      auto const id = static_cast<std::uint64_t>(bed.id[row]);
      if (uniform4(checked.seed, RandomStream::denudation, id, draw)[0] < chance) keep[row] = 0;
    }
  }
  double const before = sum_of(mass_by_material(bed, checked));
  Denuded lost{.grains = std::ranges::count(keep, char{0})};
  bed.retain(keep);
  lost.mass = before - sum_of(mass_by_material(bed, checked));
  return lost;
}

}  // namespace layerloop::coupling
