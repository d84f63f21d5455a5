// Rows of the tables of light: [laser], [optics], [scan], [absorb], [melt].
#include <numbers>

#include "core/case_rows.hpp"

namespace layerloop {

// One row a key, its sentence last.
// clang-format off
std::vector<CaseKey> laser_rows() {
  using L = LaserSettings;
  using O = OpticsSettings;
  using S = ScanSettings;
  constexpr auto laser = &Case::laser;
  constexpr auto optics = &Case::optics;
  constexpr auto scan = &Case::scan;
  return {
      {"laser", "power", at<laser, &L::power>, D::power, {1, 5000}, Need::with_laser, "", "Power of the beam."},
      {"laser", "wavelength", at<laser, &L::wavelength>, D::length, {2e-7, 1.2e-5}, Need::with_light, "",
       "Wavelength of the beam; it picks the refractive index from the material's optical constants."},
      {"laser", "spot_diameter", at<laser, &L::spot_diameter>, D::length, {1e-6, 2e-3}, Need::with_spot, "",
       "Diameter of the beam at its focus, measured by `spot_definition`; of a ring that of its crest; without a meaning for `profile` \"file\", whose table has its own lengths."},
      {"laser", "spot_definition", choice<laser, &L::spot_definition>({"1/e2", "D4sigma", "FWHM"}),
       D::none, {}, Need::with_spot, "",
       "Level at which `spot_diameter` (and `ring_width`) is measured: 1/e2 = D4sigma = 1.70 FWHM for a Gaussian, all the same for a top hat."},
      {"laser", "profile", choice<laser, &L::profile>({"gaussian", "top_hat", "ring", "file"}), D::none, {}, Need::never, "\"gaussian\"",
       "Intensity across the beam; `ring`: Gaussian across its crest; `file`: over the radius as in `profile_file`."},
      {"laser", "profile_file", at<laser, &L::profile_file>, D::none, {}, Need::never, "\"\"",
       "CSV file `r [um],intensity [W/m2]` of a round beam on the bed, ascending; its power is scaled to that of the beam."},
      {"laser", "ring_width", at<laser, &L::ring_width>, D::length, {0, 2e-3}, Need::never, "0",
       "Full width of a ring across its crest, by `spot_definition`."},
      {"laser", "ellipticity", at<laser, &L::ellipticity>, D::none, {0.05, 20}, Need::never, "1",
       "Extent of the beam along y over that along x, at the same area."},
      {"laser", "focus_offset", at<laser, &L::focus_offset>, D::length, {-0.1, 0.1}, Need::never, "0",
       "Height of the focus above the layer: the beam is wider on the bed and its rays lean apart (or together, below 0); needs `rayleigh_length`."},
      {"laser", "rayleigh_length", at<laser, &L::rayleigh_length>, D::length, {1e-6, 1}, Need::never, "",
       "Distance from the focus at which the beam is wider by the square root of 2."},
      {"laser", "incidence_angle", at<laser, &L::incidence_angle>, D::angle, {0, 85 * std::numbers::pi / 180}, Need::never, "0",
       "Angle between the beam and straight down; the beam's axis meets the level of the layer where it would without."},
      {"laser", "incidence_azimuth", at<laser, &L::incidence_azimuth>,
       D::angle, {-2 * std::numbers::pi, 2 * std::numbers::pi}, Need::never, "0",
       "Direction in which an oblique beam travels, seen from above, from x towards y."},
      {"laser", "polarisation", choice<laser, &L::polarisation>({"unpolarised", "s", "p", "x", "y", "circular"}),
       D::none, {}, Need::never, "\"unpolarised\"",
       "Field of the light that arrives: across (`s`) or in (`p`) the plane of incidence on a level bed, along x or y; anything but unpolarised is followed from hit to hit."},
      {"laser", "absorptivity", at<laser, &L::absorptivity>, D::none, {0, 1, open}, Need::never, "",
       "Share of the power that is absorbed; given, it replaces the ray tracer."},

      {"optics", "refractive_index", at<optics, &O::refractive_index>, D::none, {0, 100}, Need::never, "",
       "[n, k] of the metal at the laser's wavelength; replaces the material's."},
      {"optics", "grey_reflectance", at<optics, &O::grey_reflectance>, D::none, {0, 1}, Need::never, "",
       "Share that every hit reflects, whatever the angle; replaces all refractive indices."},
      {"optics", "floor", at<optics, &O::floor>, D::none, {}, Need::never, "\"\"",
       "What lies below the powder: a material, \"black\" (absorbs all), \"none\" (light goes through, verb absorb only); empty: the powder's material."},
      {"optics", "uniform_beam", at<optics, &O::uniform_beam>, D::none, {}, Need::never, "false",
       "Whether the verb absorb lights the whole bed evenly instead of the spot."},
      {"optics", "oxide_thickness", at<optics, &O::oxide_thickness>, D::length, {0, 5e-6}, Need::never, "0",
       "Thickness of an oxide film on all metal; see the effect surface_oxide."},
      {"optics", "oxide_index", at<optics, &O::oxide_index>, D::none, {0, 100}, Need::never, "",
       "[n, k] of that film; by default that of Al2O3 on aluminium, TiO2 on titanium, Fe2O3 on iron, and their alloys."},
      {"optics", "diffuse_share", at<optics, &O::diffuse_share>, D::none, {0, 1}, Need::never, "0",
       "Share of the reflected light that a rough surface scatters by Lambert's law; see the effect diffuse_scattering."},
      {"optics", "temperature", at<optics, &O::temperature>, D::temperature, {250, 4000}, Need::never, "\"300 K\"",
       "Temperature of the metal that reflects; see the effect optical_temperature."},
      {"optics", "polarisation_model", choice<optics, &O::polarisation_model>({"averaged", "tracked"}),
       D::none, {}, Need::never, "\"averaged\"",
       "Whether unpolarised light counts as unpolarised afresh at every hit (within 0.002 on powder), or its fields are followed."},
      {"optics", "rays", at<optics, &O::rays>, D::none, {100, 1e9}, Need::never, "20000",
       "Rays traced for each beam position."},
      {"optics", "position_spacing", at<optics, &O::position_spacing>,
       D::length, {1e-6, 1e-3}, Need::never, "\"20 um\"",
       "Distance along a track between beam positions that are traced."},
      {"optics", "retrace", at<optics, &O::retrace>, D::none, {}, Need::never, "true",
       "Whether each position is traced on the surface that has melted by then, or on the layer as it was spread."},

      {"scan", "kind", choice<scan, &S::kind>({"track", "hatch", "file"}), D::none, {}, Need::never, "\"hatch\"",
       "One track, parallel tracks to and fro, or the way of the beam as in `path`."},
      {"scan", "scan_speed", at<scan, &S::scan_speed>, D::speed, {0.01, 20}, Need::with_laser, "",
       "Speed of the beam."},
      {"scan", "track_length", at<scan, &S::track_length>, D::length, {1e-5, 0.05}, Need::with_laser, "",
       "Length of a track."},
      {"scan", "tracks", at<scan, &S::tracks>, D::none, {1, 10000}, Need::never, "1", "Tracks of a layer."},
      {"scan", "hatch_spacing", at<scan, &S::hatch_spacing>, D::length, {0, 2e-3}, Need::never, "0",
       "Distance between neighbouring tracks; needed with more than one."},
      {"scan", "rotation", at<scan, &S::rotation>,
       D::angle, {-20 * std::numbers::pi, 20 * std::numbers::pi}, Need::never, "0",
       "Turn of the tracks from layer to layer, about the middle of the deposition zone."},
      {"scan", "dwell", at<scan, &S::dwell>, D::time, {0, 100}, Need::never, "0", "Time between tracks, laser off."},
      {"scan", "direction", at<scan, &S::direction>,
       D::angle, {-2 * std::numbers::pi, 2 * std::numbers::pi}, Need::never, "0",
       "Direction of the first track of layer 1, from x towards y."},
      {"scan", "path", at<scan, &S::path>, D::none, {}, Need::never, "\"\"",
       "CSV file `x [um],y [um],power [W],speed [mm/s]` of points that the beam passes, from the middle of the deposition zone; power and speed are those on the way to the point, power 0: beam off. With `time [us]` in the place of the speed: when the beam is there."},
      {"scan", "track_index", at<scan, &S::track_index>, D::none, {1, 10000}, Need::never, "[]",
       "Numbers of the tracks of a hatch in the order in which they are scanned; empty: 1, 2, 3, ... Every second one that is scanned runs backwards."},
  };
}

std::vector<CaseKey> absorb_rows() {
  using A = AbsorbSettings;
  constexpr auto absorb = &Case::absorb;
  return {
      {"absorb", "bed", choice<absorb, &A::bed>({"spread", "settled", "file"}), D::none, {}, Need::never, "\"spread\"",
       "Bed of the verb absorb: the last of run.layers that the recoater spreads, powder.particles grains that settle on a level plate, or the file of --bed."},
      {"absorb", "plate_length", at<absorb, &A::plate_length>, D::length, {5e-5, 0.02}, Need::never, "\"300 um\"",
       "Period, along x and y, of the plate on which grains settle."},
      {"absorb", "target_standard_error", at<absorb, &A::target_standard_error>, D::none, {0, 0.5}, Need::never, "0.001",
       "Standard error of the absorptivity at which no more rays are traced; 0: optics.rays rays."},
      {"absorb", "max_rays", at<absorb, &A::max_rays>, D::none, {100, 1e12}, Need::never, "1e8",
       "Rays after which a trace ends even so."},
      {"absorb", "depth_bins", at<absorb, &A::depth_bins>, D::none, {1, 10000}, Need::never, "50",
       "Slices of the depth profile, from the top of the bed to its floor."},
      {"absorb", "map_spacing", at<absorb, &A::map_spacing>, D::length, {1e-7, 1e-3}, Need::never, "\"5 um\"",
       "Pixels of the map of absorbed light."},
  };
}

std::vector<CaseKey> melt_rows() {
  using M = MeltSettings;
  constexpr auto melt = &Case::melt;
  return {
      {"melt", "bed", choice<melt, &M::bed>({"automatic", "plate", "spread", "file"}), D::none, {}, Need::never, "\"automatic\"",
       "What the verb melt melts: a bare plate, a layer that the recoater spreads on it first, or the file of --bed. `automatic`: `spread` where there is a table [machine], else `plate`."},
      {"melt", "two_grids", at<melt, &M::two_grids>, D::none, {}, Need::never, "false",
       "Whether the exposure is repeated with cells 1.5 times as large (of a spread layer: with the nearest such that divide its width and length), for the discretisation error of pool and absorptivity."},
  };
}
// clang-format on

}  // namespace layerloop
