#pragma once
#include <optional>
#include <span>
#include <vector>

#include "thermal/effects/evaporation.hpp"
#include "thermal/effects/surface_losses.hpp"
#include "thermal/enthalpy_table.hpp"

namespace layerloop::thermal {

/// A cell of one rank that metal and gas share a surface in, and the heat that left through it.
struct OpenCell {
  std::int64_t cell;      ///< local
  double area;            ///< [m^2]
  double metal_volume;    ///< [m^3]
  double evaporated = 0;  ///< [J] so far
  double lost = 0;        ///< by radiation and convection [J] so far
};

/// Heat that free surfaces give off: the effects `evaporation` and `surface_losses`, each absent when off.
struct SurfaceSink {
  std::optional<Evaporation> evaporation;
  std::optional<SurfaceLosses> losses;
  double evaporation_onset = 0;  ///< h below which evaporation is left out: that of the solidus [J/m^3]
  std::vector<OpenCell> cells;   ///< empty when both effects are off
  double lost = 0;               ///< by radiation and convection in super steps, beside that of the cells [J] so far

  struct Flux {
    double evaporation = 0, losses = 0, slope = 0;  ///< [W/m^2], [W/m^2], d(sum)/dT [W/(m^2 K)]
    double total() const { return evaporation + losses; }
  };
  Flux flux(EnthalpyTable const& table, double h) const;
};

/// Backward Euler of the sinks alone: solves h + dt area q(T(h)) / volume = h* in one open cell and books what left.
/// q rises with h, so the root is bracketed; Newton's method, bisection where it would leave the bracket. Never
/// overshoots.
void drain(SurfaceSink const& sink, OpenCell& open, EnthalpyTable const& table, double dt, double& enthalpy);

/// Books what the fluxes at `enthalpy` take in dt (the implicit solver has them in its residual).
void book(SurfaceSink& sink, EnthalpyTable const& table, double dt, std::span<double const> enthalpy);

}  // namespace layerloop::thermal
