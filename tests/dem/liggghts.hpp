#pragma once
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "support.hpp"

namespace layerloop::dem::test {

/// The same grains in LIGGGHTS, as an independent reference.
struct Liggghts {
  ContactSettings contact = {};
  PowderBed bed = {};    ///< positions and velocities at time 0
  double width = 1e-3;   ///< period along y [m]
  bool floor = false;    ///< a plane at z = 0
  double gravity = 0;    ///< [m/s^2], downwards
  double time_step = 0;  ///< [s]
  std::int64_t steps = 0, steps_a_frame = 1;

  static bool is_installed() { return std::filesystem::exists("/usr/bin/liggghts"); }

  /// Beds after 0, steps_a_frame, 2 steps_a_frame ... steps. Velocities belong to the same time as the positions.
  std::vector<PowderBed> run() const;

 private:
  std::string data() const;
  std::string deck() const;
  std::string model() const;
};

inline std::string Liggghts::model() const {
  return std::string("hertz tangential history") + (contact.cohesion == Cohesion::none ? "" : " cohesion sjkr2") +
         (contact.rolling_friction > 0 ? " rolling_friction cdt" : "");
}

inline std::string Liggghts::data() const {
  std::string text = fmt::format(
      "grains\n\n{} atoms\n1 atom types\n\n-2e-3 2e-3 xlo xhi\n0 {:.17g} ylo yhi\n-1e-4 4e-3 zlo zhi\n\nAtoms\n\n",
      bed.size(), width);
  for (std::size_t i = 0; i < bed.size(); ++i)
    text += fmt::format("{} 1 {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", bed.id[i] + 1, 2 * bed.radius[i], density,
                        bed.x[i], bed.y[i], bed.z[i]);
  text += "\nVelocities\n\n";
  for (std::size_t i = 0; i < bed.size(); ++i)
    text += fmt::format("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", bed.id[i] + 1, bed.vx[i], bed.vy[i],
                        bed.vz[i], bed.wx[i], bed.wy[i], bed.wz[i]);
  return text;
}

inline std::string Liggghts::deck() const {
  std::string text =
      "units si\natom_style granular\natom_modify map array\nboundary f p f\nnewton off\n"
      "communicate single vel yes\nneighbor 4e-6 bin\nneigh_modify delay 0 every 1 check yes\nread_data grains.data\n";
  auto property = [&, n = 0](std::string const& name, std::string const& kind, double value) mutable {
    text += fmt::format("fix m{} all property/global {} {} {:.17g}\n", n++, name, kind, value);
  };
  property("youngsModulus", "peratomtype", contact.youngs_modulus);
  property("poissonsRatio", "peratomtype", contact.poisson_ratio);
  property("coefficientRestitution", "peratomtypepair 1", contact.restitution);
  property("coefficientFriction", "peratomtypepair 1", contact.sliding_friction);
  property("coefficientRollingFriction", "peratomtypepair 1", contact.rolling_friction);
  property("cohesionEnergyDensity", "peratomtypepair 1", contact.cohesion_energy_density);
  text += fmt::format("pair_style gran model {}\npair_coeff * *\ntimestep {:.17g}\n", model(), time_step);
  text += fmt::format("fix grav all gravity {:.17g} vector 0 0 -1\n", gravity);
  if (floor) text += fmt::format("fix floor all wall/gran model {} primitive type 1 zplane 0\n", model());
  text += fmt::format(
      "fix integr all nve/sphere\n"
      "dump d all custom {} grains.dump id radius x y z vx vy vz omegax omegay omegaz\n"
      "dump_modify d sort id format \"%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\"\n"
      "thermo 1000000\nrun {}\n",
      steps_a_frame, steps);
  return text;
}

inline std::vector<PowderBed> Liggghts::run() const {
  namespace fs = std::filesystem;
  std::string folder = (fs::temp_directory_path() / "layerloop-liggghts-XXXXXX").string();
  if (!mkdtemp(folder.data())) throw std::runtime_error("no temporary folder");
  std::ofstream(folder + "/grains.data") << data();
  std::ofstream(folder + "/deck") << deck();
  // MPI's variables name the rank of this program; the other one starts on its own
  int const failed = std::system(fmt::format("cd {} && env -i PATH=/usr/bin:/bin HOME={} OMPI_ALLOW_RUN_AS_ROOT=1 "
                                             "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 /usr/bin/liggghts -in deck > log 2>&1",
                                             folder, folder)
                                     .c_str());
  if (failed) {
    std::ifstream const log(folder + "/log");
    std::ostringstream words;
    words << log.rdbuf();
    throw std::runtime_error("liggghts failed: " + words.str());
  }
  std::vector<PowderBed> frames;
  std::ifstream dump(folder + "/grains.dump");
  for (std::string line; std::getline(dump, line);) {
    if (line.starts_with("ITEM: TIMESTEP")) frames.emplace_back();
    if (!line.starts_with("ITEM: ATOMS")) continue;
    for (std::size_t i = 0; i < bed.size() && std::getline(dump, line); ++i) {
      std::istringstream values(line);
      std::int64_t id;
      double radius, x, y, z, vx, vy, vz, wx, wy, wz;
      values >> id >> radius >> x >> y >> z >> vx >> vy >> vz >> wx >> wy >> wz;
      PowderBed& frame = frames.back();
      frame.add(id - 1, {x, y, z}, radius, 0);
      set_velocity(frame, i, {vx, vy, vz});
      frame.wx.back() = wx, frame.wy.back() = wy, frame.wz.back() = wz;
    }
  }
  fs::remove_all(folder);
  return frames;
}

/// The same in this program: beds at the same steps. Velocities are those half a step before the positions.
inline std::vector<PowderBed> run_here(Liggghts const& reference) {
  Rig rig = empty_space();
  rig.width = reference.width;
  if (reference.floor) rig.walls.blocks = {floor_block()};
  rig.gravity = {0, 0, -reference.gravity};
  Motion const motion{grain_law(reference.contact), wall_law(reference.contact), reference.contact, density,
                      reference.time_step};
  PowderBed bed = reference.bed;
  for (double& vz : bed.vz) vz += 0.5 * reference.gravity * reference.time_step;  // half a step before
  Simulation simulation(motion, rig, alone());
  simulation.scatter(bed);
  std::vector<PowderBed> frames{reference.bed};
  for (std::int64_t step = 0; step < reference.steps; step += reference.steps_a_frame) {
    simulation.advance(reference.steps_a_frame);
    frames.push_back(simulation.gather());
  }
  return frames;
}

/// Largest distance between the same grain in two beds [m].
inline double largest_distance(PowderBed const& a, PowderBed const& b, double width) {
  double largest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    Vec3 apart = a.position(i) - b.position(i);
    apart.y() = std::remainder(apart.y(), width);
    largest = std::max(largest, apart.norm());
  }
  return largest;
}

}  // namespace layerloop::dem::test
