#pragma once
#include <vector>

#include "core/case.hpp"
#include "core/powder_bed.hpp"

namespace layerloop::dem {

/// Dynamic angle of repose of the heap in front of the blade [deg]: the free surface in slices of about 25 um along x
/// (mean height over y of the tops above pixels of about 5 um), five equally spaced slices from the crest (the highest
/// of the first twelve) to the toe (the last slice above `ground` plus 12 % of the crest's height over the platforms),
/// least-squares line. Not a number when there are fewer than five slices.
/// \param ground  height of the surface that the heap moves over [m], counted when above the platforms
double heap_angle(PowderBed const& bed, MachineSettings const& machine, double blade_front, double ground);

/// Angles of a stroke, frame by frame: to be called as the blade goes. Accumulation: blade front between 40 % and 96 %
/// of the accumulation zone. Deposition: front between the first tenth of the deposition zone and its last three
/// tenths, where the heap does not yet reach the end platform.
class HeapWatch {
 public:
  /// \param settled_surface  mean height of the feed's surface before the stroke [m]
  HeapWatch(MachineSettings const& machine, double settled_surface)
      : machine_(machine), settled_surface_(settled_surface) {}

  void operator()(PowderBed const& bed, double blade_front);

  struct Angle {
    double mean, standard_error;  ///< over frames [deg]; not a number without them
  };
  Angle accumulation() const { return mean_of(accumulation_); }
  Angle deposition() const { return mean_of(deposition_); }

 private:
  static Angle mean_of(std::vector<double> const& angles);

  MachineSettings machine_;
  double settled_surface_;
  std::vector<double> accumulation_, deposition_;
};

}  // namespace layerloop::dem
