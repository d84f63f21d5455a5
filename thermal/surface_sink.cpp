#include "thermal/surface_sink.hpp"

#include <cmath>

namespace layerloop::thermal {

SurfaceSink::Flux SurfaceSink::flux(EnthalpyTable const& table, double h) const {
  Flux flux;
  double const T = table.temperature(h);
  if (evaporation && h > evaporation_onset) {
    flux.evaporation = evaporation->flux(T);
    flux.slope += evaporation->slope(T, flux.evaporation);
  }
  if (losses) {
    flux.losses = losses->flux(T);
    flux.slope += losses->slope(T);
  }
  return flux;
}

namespace {

/// Share of itself by which a flux may fall within a step for one step of Newton's method to do: what is left out is
/// the square of it.
constexpr double not_stiff = 1e-3;

/// Root of h + rate q(T(h)) = start. \param rate  dt area / volume [s/m]
double drained(SurfaceSink const& sink, EnthalpyTable const& table, double rate, double start) {
  double low = std::min(start, 0.0), high = start;  // nothing is given off at ambient
  double h = start;
  for (int iteration = 0; iteration < 100; ++iteration) {
    auto const flux = sink.flux(table, h);
    double const excess = h + rate * flux.total() - start;
    if (std::abs(excess) <= 1e-12 * std::abs(start)) break;
    (excess > 0 ? high : low) = h;
    h -= excess / (1 + rate * flux.slope * table.temperature_slope(h));
    if (!(h > low && h < high)) h = 0.5 * (low + high);
    if (high - low <= 1e-14 * std::abs(start)) break;
  }
  return h;
}

void book(OpenCell& open, SurfaceSink::Flux const& flux, double energy) {
  if (energy == 0) return;
  double const vapour = energy * flux.evaporation / flux.total();
  open.evaporated += vapour;
  open.lost += energy - vapour;
}

}  // namespace

void drain(SurfaceSink const& sink, OpenCell& open, EnthalpyTable const& table, double dt, double& h) {
  auto flux = sink.flux(table, h);
  if (flux.total() == 0) return;
  double const before = h, rate = dt * open.area / open.metal_volume;
  double const stiffness = rate * flux.slope * table.temperature_slope(h);
  if (std::abs(stiffness) < not_stiff) {
    h -= rate * flux.total() / (1 + stiffness);
  } else {
    h = drained(sink, table, rate, before);
    flux = sink.flux(table, h);
  }
  book(open, flux, (before - h) * open.metal_volume);
}

void book(SurfaceSink& sink, EnthalpyTable const& table, double dt, std::span<double const> enthalpy) {
  for (OpenCell& open : sink.cells) {
    auto const flux = sink.flux(table, enthalpy[static_cast<std::size_t>(open.cell)]);
    open.evaporated += dt * open.area * flux.evaporation;
    open.lost += dt * open.area * flux.losses;
  }
}

}  // namespace layerloop::thermal
