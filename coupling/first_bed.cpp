#include "coupling/first_bed.hpp"

#include <fmt/format.h>

#include "core/bed_file.hpp"
#include "core/error.hpp"
#include "coupling/bed_source.hpp"

namespace layerloop::coupling {

PowderBed first_bed(Case const& checked) {
  if (checked.powder.bed.empty()) return {};
  MachineSettings const& m = checked.machine;
  PowderBed bed = read_bed(checked.powder.bed).bed;
  check_materials(bed, checked, checked.powder.bed);
  wrap(bed.y, m.width);
  for (std::size_t i = 0; i < bed.size(); ++i) {
    double const ground = bed.x[i] < m.deposition_begin() ? -m.accumulation_depth : 0;
    bool const inside = bed.x[i] >= 0 && bed.x[i] <= m.deposition_end() && bed.z[i] > ground + 0.9 * bed.radius[i];
    if (!inside)
      throw InputError(fmt::format(
          "{}: grain {} lies at x = {:.4g}, z = {:.4g} m (outside the machine's zones, x from 0 to {:.4g} m, or in "
          "their floor, z = {:.4g} m) x = 0 is the left edge of the accumulation zone, z = 0 the level of the "
          "platforms, "
          "where the plate's top is before layer 1",
          checked.powder.bed, bed.id[i], bed.x[i], bed.z[i], m.deposition_end(), ground));
  }
  return bed;
}

}  // namespace layerloop::coupling
