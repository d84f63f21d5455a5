#pragma once
#include "core/material.hpp"
#include "core/melt_record.hpp"

namespace layerloop::thermal {

/// A Gaussian beam that moves steadily over a half space whose properties do not change. SI.
struct MovingBeam {
  double absorbed_power;
  double speed;
  double spot_radius;  ///< 1/e2
  double ambient_temperature;
};

/// Properties of that half space.
struct ConstantMetal {
  double conductivity, heat_capacity;  ///< [W/(m K)], [J/(m^3 K)]
  double melting_point;                ///< [K]
};

/// Conductivity at the solidus, and the heat from ambient through melting shared out evenly over the temperatures.
ConstantMetal constant_metal_of(Material const& material, double ambient_temperature);

/// Temperature [K] at a place relative to the beam, which moves along x; z counts downwards.
/// Source: Eagar & Tsai, Welding Journal 62 (1983) 346s.
double eagar_tsai_temperature(MovingBeam const& beam, ConstantMetal const& metal, Vec3 const& place);

/// Width, depth and length of what is above the melting point, to 1e-4 of the spot radius; zeros where nothing is.
PoolSize eagar_tsai_pool(MovingBeam const& beam, ConstantMetal const& metal);

}  // namespace layerloop::thermal
