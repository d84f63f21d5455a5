#include "coupling/effects/plume_attenuation.hpp"

#include <cmath>

#include "core/effect_catalogue.hpp"

namespace layerloop::coupling {

Plume::Plume(Case const& checked) {
  auto const parameter = [&](char const* name) { return effect_parameter(checked.effects, "plume_attenuation", name); };
  double const direction = parameter("flow_direction");
  depth_per_rate_ = checked.effect_strength("plume_attenuation") / parameter("rate_of_unit_depth");
  relaxation_time_ = parameter("relaxation_time");
  asymmetry_ = parameter("flow_asymmetry");
  flow_ = Vec3(std::cos(direction), std::sin(direction), 0);
}

void Plume::feed(double vapour_rate, double duration) {
  double const kept = relaxation_time_ > 0 ? std::exp(-duration / relaxation_time_) : 0;
  rate_ = kept * rate_ + (1 - kept) * vapour_rate;
}

double Plume::transmission(Vec3 const& along) const {
  return std::exp(-depth_per_rate_ * rate_ * (1 + asymmetry_ * flow_.dot(along)));
}

}  // namespace layerloop::coupling
