#include "dem/loose_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "dem/dosing.hpp"
#include "dem/mixture.hpp"

namespace layerloop::dem {
namespace {
constexpr std::uint32_t draws_a_height = 200;

/// Grains by slabs of height, for the question whether a sphere has room.
class Slabs {
 public:
  Slabs(CloudSpace const& space, double largest_radius) : space_(space), height_(2 * largest_radius) {}

  void add(Vec3 const& centre, double radius) {
    std::size_t const k = slab(centre.z());
    if (slabs_.size() <= k) slabs_.resize(k + 1);
    slabs_[k].push_back({centre, radius});
  }

  bool has_room(Vec3 const& centre, double radius) const {
    std::size_t const k = slab(centre.z());
    for (std::size_t s = k > 0 ? k - 1 : 0; s < std::min(k + 2, slabs_.size()); ++s) {
      for (auto const& [other, other_radius] : slabs_[s]) {
        Vec3 apart = other - centre;
        apart.x() = std::remainder(apart.x(), space_.period_x);
        apart.y() = std::remainder(apart.y(), space_.period_y);
        double const reach = radius + other_radius;
        if (apart.squaredNorm() < reach * reach) return false;
      }
    }
    return true;
  }

 private:
  struct Sphere {
    Vec3 centre;
    double radius;
  };
  std::size_t slab(double z) const { return static_cast<std::size_t>(std::max(z - space_.low.z(), 0.0) / height_); }

  CloudSpace space_;
  double height_;
  std::vector<std::vector<Sphere>> slabs_;
};

/// Centre in the box, shrunk by the radius on the sides that are not periodic.
Vec3 draw_centre(CloudSpace const& space, double radius, std::array<double, 4> const& u) {
  auto const between = [&](double low, double high, double period, double share) {
    double const margin = std::isinf(period) ? radius : 0.0;
    return low + margin + share * std::max(high - low - 2 * margin, 0.0);
  };
  double const open = std::numeric_limits<double>::infinity();
  return {between(space.low.x(), space.high.x(), space.period_x, u[0]),
          between(space.low.y(), space.high.y(), space.period_y, u[1]),
          between(space.low.z(), space.high.z(), open, u[2])};
}

bool is_in_cylinder(CloudSpace const& space, Vec3 const& centre, double radius) {
  Vec3 const middle = 0.5 * (space.low + space.high);
  return std::hypot(centre.x() - middle.x(), centre.y() - middle.y()) + radius <= space.radius;
}
}  // namespace

void add_loose_cloud(PowderBed& bed, Case const& checked, CloudSpace space, std::int64_t count, std::int64_t next_id,
                     double fall_speed) {
  double const largest = *std::ranges::max_element(checked.powder.diameters) / 2;
  Slabs slabs(space, largest);
  for (std::size_t i = 0; i < bed.size(); ++i) slabs.add(bed.position(i), bed.radius[i]);
  for (std::int64_t id = next_id; id < next_id + count; ++id) {
    double const radius = draw_radius(checked, id);
    for (std::uint32_t draw = 0;; ++draw) {
      if (draw % draws_a_height == draws_a_height - 1) space.high.z() += largest;
      auto const u = uniform4(checked.seed, RandomStream::grain_position, static_cast<std::uint64_t>(id), draw);
      Vec3 const centre = draw_centre(space, radius, u);
      if (!is_in_cylinder(space, centre, radius) || !slabs.has_room(centre, radius)) continue;
      slabs.add(centre, radius);
      bed.add(id, centre, radius, draw_material(checked, id));
      bed.vz.back() = -fall_speed;
      break;
    }
  }
}

}  // namespace layerloop::dem
