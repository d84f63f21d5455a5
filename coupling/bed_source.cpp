#include "coupling/bed_source.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"

namespace layerloop::coupling {

void check_materials(PowderBed& bed, Case const& checked, std::string const& path) {
  for (std::size_t i = 0; i < bed.size(); ++i) {
    if (checked.admixtures.empty()) bed.material[i] = 0;
    if (bed.material[i] < 0 || static_cast<std::size_t>(bed.material[i]) > checked.admixtures.size())
      throw InputError(
          fmt::format("{}: grain {} has material {} (the case has materials 0 to {}: powder.material, then "
                      "the others of [powder.mixture] by name) give it one of them",
                      path, bed.id[i], bed.material[i], checked.admixtures.size()));
  }
}

void wrap(std::vector<double>& coordinate, double period) {
  for (double& at : coordinate) {
    if (period > 0) at -= period * std::floor(at / period);
    if (period > 0 && at >= period) at = 0;
  }
}

BedFile read_source(BedSource const& source, Case const& checked) {
  BedFile file = read_bed(source.bed);
  file.periodic_x = source.periodic_x.value_or(file.periodic_x.value_or(0));
  file.periodic_y = source.periodic_y.value_or(file.periodic_y.value_or(0));
  if (source.floor_z) file.floor_z = source.floor_z;
  check_materials(file.bed, checked, source.bed.string());
  wrap(file.bed.x, *file.periodic_x);
  wrap(file.bed.y, *file.periodic_y);
  return file;
}

}  // namespace layerloop::coupling
