#include "validation/quantity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/statistics.hpp"

namespace layerloop::validation {
namespace {

using coupling::LayerRecord;
using coupling::MeltStudy;
using coupling::RunRecord;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = std::numbers::pi / 180;

LayerRecord const* layer_of(RunRecord const& record, Spot const& spot) {
  auto const layers = static_cast<int>(record.layers.size());
  int const layer = spot.layer.value_or(layers);
  return layer >= 1 && layer <= layers ? &record.layers[static_cast<std::size_t>(layer - 1)] : nullptr;
}

/// Standard error of a mean over the slices of the zone, as if they were independent.
double scatter_of_slices(LayerMetrics const& metrics, double ZoneMetrics::*figure) {
  std::vector<double> values;
  for (LayerBin const& bin : metrics.bins) values.push_back(bin.*figure);
  Sample const sample = sample_of(values);
  return sample.n > 1 ? sample.sd / std::sqrt(static_cast<double>(sample.n)) : 0;
}

/// A figure of the spread layer, at a place that of the nearest slice.
auto layer_figure(double ZoneMetrics::*figure, double ZoneMetrics::*u_num = nullptr) {
  return [=](RunRecord const& record, Spot const& spot) -> Reading {
    LayerRecord const* const layer = layer_of(record, spot);
    if (!layer) return {nan};
    LayerMetrics const& metrics = layer->metrics;
    double const error = scatter_of_slices(metrics, figure);
    if (!spot.x || metrics.bins.empty())
      return {metrics.*figure, u_num ? static_cast<ZoneMetrics const&>(metrics).*u_num : 0, error};
    LayerBin const& bin = *std::ranges::min_element(metrics.bins, {}, [&](auto& b) { return std::abs(b.x - *spot.x); });
    return {bin.*figure, u_num ? static_cast<ZoneMetrics const&>(bin).*u_num : 0,
            error * std::sqrt(static_cast<double>(metrics.bins.size()))};
  };
}

Reading heap_angle(RunRecord const& record, Spot const& spot) {
  LayerRecord const* const layer = layer_of(record, spot);
  if (!layer) return {nan};
  return {degree * layer->stroke.heap_angle_deposition, 0, degree * layer->stroke.heap_angle_deposition_u_num};
}

Reading absorptivity_of_layer(RunRecord const& record, Spot const& spot) {
  LayerRecord const* const layer = layer_of(record, spot);
  return layer ? Reading{layer->absorptivity, 0, layer->absorptivity_standard_error} : Reading{nan};
}

Reading part_density(RunRecord const& record, Spot const& spot) {
  LayerRecord const* const layer = layer_of(record, spot);
  return layer ? Reading{layer->consolidation.part_relative_density} : Reading{nan};
}

auto pool_of_layer(double PoolSize::*figure) {
  return [=](RunRecord const& record, Spot const& spot) -> Reading {
    LayerRecord const* const layer = layer_of(record, spot);
    return layer ? Reading{layer->pool.*figure, layer->pool_u_num.*figure} : Reading{nan};
  };
}

/// The pool at mid-track, at a place that of the nearest section.
auto pool_size(double PoolSize::*figure, double TrackSection::*local = nullptr) {
  return [=](MeltStudy const& study, Spot const& spot) -> Reading {
    MeltRecord const& melt = study.melted.heat.melt;
    double const u = study.u_num.*figure;
    if (!spot.x || !local || melt.sections.empty()) return {melt.pool.*figure, u};
    auto const distance = [&](TrackSection const& s) {
      return std::hypot(s.x - *spot.x, spot.y ? s.y - *spot.y : 0.0);
    };
    return {(*std::ranges::min_element(melt.sections, {}, distance)).*local, u};
  };
}

Reading absorptivity_of_melt(MeltStudy const& study, Spot const&) {
  AbsorbedPower const& light = study.melted.exposure.mean;
  return {light.absorptivity, study.absorptivity_u_mesh, light.standard_error};
}

Reading absorptivity_of_bed(coupling::AbsorptionStudy const& study) {
  coupling::AbsorptionFigure const figure = study.absorptivity(0);
  return {figure.value, 0, figure.standard_error};
}

Reading regime(MeltStudy const& study, Spot const&) {
  auto const word = std::ranges::find(regime_words(), coupling::name_of(study.regime));
  return {static_cast<double>(word - regime_words().begin())};
}

/// `u_num` of an angle is half a 95 % interval.
auto angle(coupling::MeasuredAngle coupling::CalibrationPoint::*figure) {
  return [=](coupling::CalibrationPoint const& point) -> Reading {
    return {(point.*figure).value, 0, (point.*figure).u_num / 1.96};
  };
}

std::vector<Quantity> make_table() {
  using D = Dimension;
  using enum EffectStage;
  Range const size{0, 1e-2}, share{-0.05, 1.05}, slope{0, 0.5 * std::numbers::pi}, grain{1e-7, 1e-3};
  std::string const middle = ", mean over sections between a quarter and three quarters of the track";
  return {
      {"pool.width", D::length, heat, Verb::melt, size,
       "largest width of what was above the isotherm, in a plane across the track" + middle,
       pool_of_layer(&PoolSize::width), pool_size(&PoolSize::width, &TrackSection::width)},
      {"pool.depth", D::length, heat, Verb::melt, size,
       "depth of the isotherm below the surface that the powder was spread on" + middle,
       pool_of_layer(&PoolSize::depth), pool_size(&PoolSize::depth, &TrackSection::depth)},
      {"pool.length", D::length, heat, Verb::melt, size,
       "extent along the track of what is above the isotherm at one instant", pool_of_layer(&PoolSize::length),
       pool_size(&PoolSize::length)},
      {"track.regime",
       D::none,
       heat,
       Verb::melt,
       {},
       "none, no_fusion, conduction, transition, keyhole or balling",
       {},
       regime},
      {"absorptivity", D::none, laser, Verb::absorb, share,
       "absorbed over incident power, mean over the exposure or the evenly lit bed", absorptivity_of_layer,
       absorptivity_of_melt, absorptivity_of_bed},
      {"bed.relative_density", D::none, dem, Verb::spread, share,
       "volume of the grains that the stroke added to the deposition zone over its area times the mean rise of the "
       "surface (RELT)",
       layer_figure(&ZoneMetrics::volume_fraction_real, &ZoneMetrics::volume_fraction_real_u_num)},
      {"bed.effective_thickness", D::length, dem, Verb::spread, size,
       "ELT: mean height of the surface above the plane one nominal layer below the blade",
       layer_figure(&ZoneMetrics::effective_thickness, &ZoneMetrics::effective_thickness_u_num)},
      {"bed.surface_coverage", D::none, dem, Verb::spread, share,
       "share of the area under the projected grains that the stroke added",
       layer_figure(&ZoneMetrics::surface_coverage)},
      {"bed.roughness_sa", D::length, dem, Verb::spread, size,
       "Sa: mean distance of the surface from its mean height, no filter",
       layer_figure(&ZoneMetrics::roughness_sa, &ZoneMetrics::roughness_sa_u_num)},
      {"bed.d10", D::length, dem, Verb::spread, grain,
       "diameter below which grains hold 10 % of the volume that the stroke added", layer_figure(&ZoneMetrics::d10)},
      {"bed.d50", D::length, dem, Verb::spread, grain, "the same for 50 %", layer_figure(&ZoneMetrics::d50)},
      {"bed.d90", D::length, dem, Verb::spread, grain, "the same for 90 %", layer_figure(&ZoneMetrics::d90)},
      {"pile.angle_of_repose",
       D::angle,
       dem,
       Verb::calibrate,
       slope,
       "slope of the flank of a pile on a round base",
       {},
       {},
       {},
       angle(&coupling::CalibrationPoint::repose)},
      {"plate.slipping_angle",
       D::angle,
       dem,
       Verb::calibrate,
       slope,
       "tilt at which a layer of grains slips off a plate",
       {},
       {},
       {},
       angle(&coupling::CalibrationPoint::slip)},
      {"heap.angle", D::angle, dem, Verb::spread, slope,
       "slope of the heap in front of the blade over the deposition zone", heap_angle},
      {"part.relative_density", D::none, solid, Verb::run, share,
       "metal over metal and enclosed voids of the part so far, plate left out", part_density},
  };
}

}  // namespace

std::vector<Quantity> const& quantities() {
  static std::vector<Quantity> const table = make_table();
  return table;
}

Quantity const* find_quantity(std::string const& name) {
  auto const found = std::ranges::find(quantities(), name, &Quantity::name);
  return found == quantities().end() ? nullptr : &*found;
}

std::vector<std::string> quantity_names() {
  std::vector<std::string> names;
  for (Quantity const& quantity : quantities()) names.push_back(quantity.name);
  return names;
}

std::vector<std::string> const& regime_words() {
  using enum coupling::Regime;
  static std::vector<std::string> const words = [] {
    std::vector<std::string> all;
    for (coupling::Regime const one : {none, no_fusion, conduction, transition, keyhole, balling})
      all.push_back(coupling::name_of(one));
    return all;
  }();
  return words;
}

}  // namespace layerloop::validation
