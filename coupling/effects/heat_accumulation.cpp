#include "coupling/effects/heat_accumulation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/effect_catalogue.hpp"
#include "core/error.hpp"

namespace layerloop::coupling {

double pulse_rise(Slab const& slab, double energy_per_area, double time) {
  double const d = slab.thickness, diffusivity = slab.conductivity / slab.capacity;
  double sum = 0;
  for (int n = 0;; ++n) {
    double const mode = (n + 0.5) * std::numbers::pi / d, term = std::exp(-mode * mode * diffusivity * time);
    sum += term;
    if (term <= 1e-17 * sum) break;
  }
  return 2 * energy_per_area / (slab.capacity * d) * sum;
}

double part_area(Case const& checked) {
  double const tracks = checked.scan.kind == ScanKind::track ? 1 : static_cast<double>(checked.scan.tracks);
  return checked.scan.track_length * tracks * checked.scan.hatch_spacing;
}

double start_temperature(Case const& checked, std::span<double const> layer_energy) {
  double const ambient = checked.heat.ambient_temperature, strength = checked.effect_strength("heat_accumulation");
  if (strength == 0) return ambient;
  auto const parameter = [&](char const* name) { return effect_parameter(checked.effects, "heat_accumulation", name); };
  Material const& metal = checked.material;
  Slab const slab{parameter("plate_thickness"), metal.conductivity(ambient),
                  metal.density * metal.specific_heat(ambient)};
  double const layer_time = parameter("layer_time");
  auto const computed = static_cast<std::int64_t>(layer_energy.size());
  double rise = 0;
  for (std::int64_t ago = 1; ago <= computed; ++ago)
    rise +=
        pulse_rise(slab, layer_energy[static_cast<std::size_t>(computed - ago)], static_cast<double>(ago) * layer_time);
  auto const earlier = std::llround(parameter("earlier_layers"));
  for (std::int64_t ago = computed + 1; ago <= computed + earlier; ++ago)
    rise += pulse_rise(slab, parameter("layer_energy"), static_cast<double>(ago) * layer_time);
  double const start = ambient + strength * rise;
  if (start >= metal.solidus)
    throw PhysicsError(
        fmt::format("effects.heat_accumulation: layer {} would start at {:.0f} K (the metal melts at {:.0f} K) raise "
                    "layer_time or lower plate_thickness",
                    computed + 1, start, metal.solidus));
  return start;
}

}  // namespace layerloop::coupling
