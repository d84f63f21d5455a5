#pragma once
#include <cstdint>
#include <limits>

#include "core/case.hpp"
#include "core/powder_bed.hpp"
#include "core/vec3.hpp"

namespace layerloop::dem {

/// Where a loose cloud of grains is drawn: a box, or the upright cylinder of `radius` around the box's axis.
struct CloudSpace {
  Vec3 low, high;                                             ///< corners; `high` is raised when the cloud is full [m]
  double radius = std::numeric_limits<double>::infinity();    ///< [m]
  double period_x = std::numeric_limits<double>::infinity();  ///< [m]; infinity: grains stay inside the box
  double period_y = std::numeric_limits<double>::infinity();
};

/// Adds grains with ids next_id ... next_id + count - 1, sizes as the case says, by random sequential addition: none
/// overlaps another or a grain that is there, all fall at `fall_speed` [m/s]. Depends on seed, ids and bed only.
void add_loose_cloud(PowderBed& bed, Case const& checked, CloudSpace space, std::int64_t count, std::int64_t next_id,
                     double fall_speed);

}  // namespace layerloop::dem
