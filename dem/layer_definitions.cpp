#include "dem/layer_metrics.hpp"

namespace layerloop::dem {
namespace {

std::map<std::string, std::string> zone_definitions() {
  std::string const interior =
      " Taken over the interior of the deposition zone: its full width, without two largest grain diameters at either "
      "end along x.";
  std::string const added = " of the grains that were not in the deposition zone before; grains count by their centre.";
  return {
      {"effective_thickness",
       "ELT: mean height of the surface after spreading above the plane one nominal layer thickness below the "
       "blade. The surface is the top of the highest grain or solid over the centre of each pixel." +
           interior},
      {"real_effective_thickness",
       "RELT: mean height of the surface after spreading minus that before it, both with the plate lowered." +
           interior},
      {"void_layer",
       "VL: height of the blade's lower edge minus the mean height of the surface before spreading; VL(n+1) = NLT(n+1) "
       "+ NLT(n) - ELT(n) where nothing moves between the layers." +
           interior},
      {"volume_fraction_nominal",
       "Volume of the grains in the zone after spreading minus that before it, over area times nominal layer "
       "thickness; grains count by their centre." +
           interior},
      {"volume_fraction_real", "The same volume over area times RELT; null without a layer." + interior},
      {"surface_coverage", "Share of the area under the projected discs" + added +
                               " The exact area of the union of the discs, not a count of pixels." + interior},
      {"roughness_sa",
       "Sa: mean distance of the surface after spreading from its mean height (no filter, no tilt removed)." +
           interior},
      {"roughness_sq", "Sq: root mean square of the same distances." + interior},
      {"roughness_sz", "Sz: highest minus lowest point of the same surface." + interior},
      {"d10", "Smallest diameter such that grains up to it hold 10 % of the volume" + added + interior},
      {"d50", "The same for 50 %." + interior},
      {"d90", "The same for 90 %." + interior},
      {"d10_number", "Smallest diameter such that grains up to it are 10 % of the number" + added + interior},
      {"d50_number", "The same for 50 %." + interior},
      {"d90_number", "The same for 90 %." + interior},
      {"mean_diameter", "Number mean D[1,0]" + added + " Null without grains." + interior},
      {"sauter_diameter", "D[3,2] = sum d^3 / sum d^2" + added + interior},
      {"mass_diameter", "D[4,3] = sum d^4 / sum d^3" + added + interior},
      {"coordination_number",
       "Mean number of other grains that a grain touches (positions only, walls and plate do not count)" + added +
           interior},
      {"rattler_fraction", "Share with at most one such contact" + added + interior},
      {"segregation_index",
       "(D50_front - D50_rear) / D50_fed with D50 by volume; front is the third of the interior that the blade "
       "reaches first, rear the last third."},
      {"lacey_index",
       "Lacey's mixing index over the bins of the share by number of coarse grains (at least the median diameter by "
       "number of the fed powder): 1 mixed at random, 0 apart; null when all grains are alike."},
      {"*_u_num",
       "Of thicknesses, volume fraction and roughness: standard error by the finite number of pixels, from the scatter "
       "between the four grids of every second pixel. Exact figures (coverage, sizes, counts) have none."},
      {"bins",
       "run.bins equal slices of the whole deposition zone along x, x at their centre. relative_density is "
       "volume_fraction_real of the slice; every other quantity is defined as for the layer, over the slice."},
  };
}

std::map<std::string, std::string> stroke_definitions() {
  std::string const angle =
      " Slope of the least-squares line through five equally spaced slices of the heap's free surface in front of the "
      "blade, from the crest (highest of the first twelve slices of about 25 um; a slice's height is the mean over y "
      "of the tops above pixels of about 5 um) to the toe (the last slice above the ground by 12 % of the crest's "
      "height over the platforms). Mean over frames, one each 50 um of travel; in degrees.";
  return {
      {"heap_angle_accumulation",
       "Dynamic angle of repose while the blade front is between 40 % and 96 % of the accumulation zone; ground: the "
       "settled feed." +
           angle},
      {"heap_angle_deposition",
       "The same while the blade front is between 10 % and 70 % of the deposition zone; ground: the platforms." +
           angle},
      {"heap_angle_*_u_num", "Standard error over the frames. Neighbouring frames are not independent: a lower bound."},
      {"settled_height",
       "Mean height of the feed's surface over the floor of the accumulation zone before the stroke, without the outer "
       "100 um of the zone along x (bare floor counts as 0)."},
      {"settled_density",
       "Volume of the grains with their centre in the accumulation zone over its area times settled_height."},
      {"reservoir_mean_diameter",
       "Number mean of the grains with their centre in the accumulation zone after the stroke."},
      {"reservoir_mean_diameter_before", "The same before the stroke, after settling."},
      {"reservoir_mass_ratio", "Mass of the grains in the accumulation zone after the stroke over that before it."},
      {"mean_blade_force", "The same, mean over the stroke."},
      {"bond_number", "Pull-off force of two grains of the median radius over the weight of one."},
      {"steps_per_contact", "Time steps in a Hertz impact of two of the smallest grains at the recoating speed."},
      {"largest_overlap", "Largest overlap of the stroke and the rest after it, over the smaller grain's diameter."},
      {"blade_force",
       "Largest force of the grains against the stroke over the machine's periodic width, in newton; sampled every few "
       "steps."},
  };
}
}  // namespace

std::map<std::string, std::string> definitions() {
  std::map<std::string, std::string> all = zone_definitions();
  all.merge(stroke_definitions());
  return all;
}

}  // namespace layerloop::dem
