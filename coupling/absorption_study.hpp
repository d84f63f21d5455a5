#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "core/communicator.hpp"
#include "coupling/lit_bed.hpp"
#include "raytrace/absorption.hpp"

namespace layerloop::coupling {

struct AbsorbOptions {
  std::filesystem::path folder;       ///< results go here; made when missing; empty: nothing is written
  std::filesystem::path spread = {};  ///< folder of a layer that is spread, with run.replicates = 1; empty: in `folder`
  std::vector<BedSource> beds;        ///< files, where absorb.bed is one
  std::vector<std::string> materials;  ///< further ones that the powder might be of
  std::vector<double> wavelengths;     ///< further ones [m]
  std::vector<double> temperatures;    ///< further ones of the metal [K]
  bool derivatives = false;            ///< of the absorptivity with respect to n and k
  bool quiet = false;
};

/// One bed under the light.
struct BedAbsorption {
  std::string name;  ///< "seed 7", or the file
  std::string origin;
  BedMeasures measures;
  raytrace::Absorption light;
};

/// Over independent beds. Ray noise and spread from bed to bed stay apart.
struct AbsorptionFigure {
  double value = 0;           ///< mean over the beds
  double standard_error = 0;  ///< of that mean, from the rays alone
  std::int64_t n = 0;         ///< beds
  double u_bed = 0;           ///< half width of the 95 % t-interval over beds; not a number below two
  double sd_bed = 0;          ///< standard deviation from bed to bed, the rays' share taken out
};
AbsorptionFigure figure_over_beds(std::vector<double> const& values, std::vector<double> const& errors);

struct AbsorptionStudy {
  std::vector<raytrace::OpticalSet> sets;  ///< the case's own first
  std::vector<BedAbsorption> beds;
  raytrace::Beam beam;  ///< over the last bed
  LitBed last;
  double time_dem = 0, time_rays = 0;  ///< [s]

  AbsorptionFigure absorptivity(std::size_t set) const;
  AbsorptionFigure by_material(std::size_t set, std::size_t material) const;
  AbsorptionFigure substrate(std::size_t set) const;
};

/// Makes or reads the beds (run.replicates seeds), traces them and writes summary.json, CSV tables, pictures and
/// report.html. @note Collective \throws InputError, FileError, PhysicsError, StoppedBySignal
AbsorptionStudy run_absorption(Case const& checked, AbsorbOptions const& options, Communicator const& comm);

}  // namespace layerloop::coupling
