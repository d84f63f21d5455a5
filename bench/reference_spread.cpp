// One layer spread on a rig made of triangles, the same for this program and for LIGGGHTS, step for step:
//   x: platform 300 um | pit 1250, 300 deep | platform 150 | recess 1250, 100 deep | platform 300; y periodic, 175 um
//   blade 250 um wide, its lower face level with the platforms, front from 290 to 3210 um at 100 mm/s
// 4500 grains (13, 21, 28, 42 um; 0.2, 0.2, 0.5, 0.1 by number) are dropped at 0.1 m/s from a loose cloud, settle for
// 6 ms, are spread, and rest for 10 ms. Writes dumps in the text format of LIGGGHTS, for reference_spread.py.
//   reference_spread OUT [SEED [TAG [sleep]]]          sleep: grains at rest sleep (dem/sleep.hpp)
#include <fmt/format.h>
#include <mpi.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/error.hpp"
#include "core/random.hpp"
#include "core/rayleigh_time.hpp"
#include "core/write_file.hpp"
#include "dem/settled_bed_bench.hpp"
#include "dem/simulation.hpp"

namespace {
using namespace layerloop;
using namespace layerloop::dem;

constexpr double um = 1e-6, width = 175 * um, speed = 0.1, stroke = 2920 * um;
constexpr double settling = 6e-3, rest = 10e-3;
constexpr std::int64_t frames = 58;

using Line = std::vector<std::array<double, 2>>;  // x, z

void add_arc(Line& line, double x, double z, double radius, double from, double to, int parts) {
  for (int k = 0; k <= parts; ++k) {
    double const angle = (from + (to - from) * k / parts) * std::numbers::pi / 180;
    line.push_back({x + radius * std::cos(angle), z + radius * std::sin(angle)});
  }
}

/// Segments no longer than `longest`.
Line cut(Line const& line, double longest) {
  Line fine{line.front()};
  for (std::size_t k = 1; k < line.size(); ++k) {
    auto const [x0, z0] = line[k - 1];
    auto const [x1, z1] = line[k];
    double const length = std::hypot(x1 - x0, z1 - z0);
    if (length < 1e-6 * um) continue;
    int const parts = std::max(1, static_cast<int>(std::ceil(length / longest - 1e-9)));
    for (int p = 1; p <= parts; ++p) fine.push_back({x0 + (x1 - x0) * p / parts, z0 + (z1 - z0) * p / parts});
  }
  return fine;
}

/// Five strips of triangles along y; the solid lies to the right of the line as one walks along it.
TriangleSurface extrude(Line const& line) {
  constexpr int strips = 5;
  TriangleSurface surface;
  for (auto const& [x, z] : line)
    for (int j = 0; j <= strips; ++j) surface.vertices.emplace_back(x, width * j / strips, z);
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    for (int j = 0; j < strips; ++j) {
      auto const at = [&](std::size_t row, int column) {
        return static_cast<std::int32_t>(row * (strips + 1)) + column;
      };
      surface.triangles.push_back({at(k, j), at(k + 1, j), at(k + 1, j + 1)});
      surface.triangles.push_back({at(k, j), at(k + 1, j + 1), at(k, j + 1)});
    }
  }
  return surface;
}

TriangleSurface base_mesh() {
  double const r = 20 * um, x1 = 300 * um, x2 = 1550 * um, x3 = 1700 * um, x4 = 2950 * um, x5 = 3250 * um;
  double const pit = -300 * um, recess = -100 * um, end = 0.5 * um;
  Line line{{end, 0}};
  add_arc(line, x1 - r, -r, r, 90, 0, 6);
  line.insert(line.end(), {{x1, pit}, {x2, pit}});
  add_arc(line, x2 + r, -r, r, 180, 90, 6);
  add_arc(line, x3 - r, -r, r, 90, 0, 6);
  line.insert(line.end(), {{x3, recess}, {x4, recess}});
  add_arc(line, x4 + r, -r, r, 180, 90, 6);
  line.push_back({x5 - end, 0});
  return extrude(cut(line, 60 * um));
}

TriangleSurface blade_mesh() {
  double const front = 290 * um, back = front - 250 * um, top = 800 * um, r = 5 * um;
  Line line{{front, top}};
  add_arc(line, front - r, r, r, 360, 270, 3);
  add_arc(line, back + r, r, r, 270, 180, 3);
  line.push_back({back, top});
  return extrude(cut(line, 100 * um));
}

/// Random sequential addition, the largest first, every sphere wholly within the region.
PowderBed cloud(std::uint64_t seed) {
  struct Size {
    double radius;
    int count;
  };
  double const x0 = 322 * um, x1 = 1528 * um, z0 = -299 * um, z1 = 560 * um;
  PowderBed bed;
  std::uint64_t draw = 0;
  for (auto const& [radius, count] :
       {Size{21 * um, 450}, Size{14 * um, 2250}, Size{10.5 * um, 900}, Size{6.5 * um, 900}}) {
    for (int placed = 0; placed < count; ++draw) {
      auto const u = uniform4(seed, RandomStream::grain_position, draw);
      auto const within = [&](double share, double low, double high) {
        return low + radius + share * (high - low - 2 * radius);
      };
      Vec3 const centre(within(u[0], x0, x1), within(u[1], 0, width), within(u[2], z0, z1));
      bool free = true;
      for (std::size_t i = 0; i < bed.size() && free; ++i)
        free = (bed.position(i) - centre).norm() >= bed.radius[i] + radius;
      if (!free) continue;
      bed.add(static_cast<std::int64_t>(bed.size()) + 1, centre, radius, 0);
      bed.vz.back() = -0.1;
      ++placed;
    }
  }
  return bed;
}

void dump(PowderBed const& bed, std::int64_t step, std::filesystem::path const& path) {
  std::string text = fmt::format(
      "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff pp ff\n0 3.25e-3\n0 {}\n-3.05e-4 8.2e-4\n"
      "ITEM: ATOMS id radius x y z vx vy vz\n",
      step, bed.size(), width);
  for (std::size_t i = 0; i < bed.size(); ++i)
    text += fmt::format("{} {} {} {} {} {} {} {}\n", bed.id[i], bed.radius[i], bed.x[i], bed.y[i], bed.z[i], bed.vx[i],
                        bed.vy[i], bed.vz[i]);
  write_file(path, text);
}

Rig rig(double blade_moved, double blade_speed) {
  Rig rig;
  rig.walls.substrate = base_mesh();
  rig.walls.meshes = {{"the blade", blade_mesh(), {.velocity = blade_speed}}};
  rig.walls.meshes[0].surface.shift(Vec3(blade_moved, 0, 0));
  rig.walls.blocks = {{"the plane x = 0", -1e-3, 0, -1e-3, 2e-3, 0}};
  rig.width = width;
  rig.x_range = {-1e-3, 4e-3};
  rig.z_range = {-400 * um, 3e-3};
  rig.sink_x = 3250 * um;
  rig.sink_z = 820 * um;
  return rig;
}

void run(std::filesystem::path const& out, std::uint64_t seed, std::string const& tag, bool grains_sleep) {
  double const density = 9187, fraction = thesis_contact().time_step_fraction;
  Motion const motion{.between_grains = grain_law(thesis_contact()),
                      .at_walls = wall_law(thesis_contact()),
                      .contact = thesis_contact(),
                      .density = density,
                      .time_step = fraction * rayleigh_time(6.5 * um, density, thesis_contact()),
                      .grains_sleep = grains_sleep};
  auto const steps = [&](double time) { return static_cast<std::int64_t>(time / motion.time_step); };
  auto const path = [&](std::string const& name) { return out / fmt::format("spread_{}_{}", tag, name); };
  Communicator const comm;
  std::filesystem::create_directories(out);
  PowderBed bed = cloud(seed);

  Simulation settle(motion, rig(0, 0), comm);
  settle.scatter(bed);
  settle.advance(steps(settling));
  bed = settle.gather();
  std::int64_t step = steps(settling) + 1;  // as the reference counts: frames come at multiples of their distance
  dump(bed, step, path("settled.dump"));

  Simulation pass(motion, rig(0, speed), comm);
  pass.scatter(bed);
  std::int64_t const moving = steps(stroke / speed), between = moving / frames, begin = step;
  while (pass.steps() < moving) {
    pass.advance(std::min(between - step % between, moving - pass.steps()));
    step = begin + pass.steps();
    if (step % between == 0) dump(pass.gather(), step, path(fmt::format("{:09}.frame", step)));
  }
  bed = pass.gather();
  double const moved = speed * pass.time();
  double worst = 0;
  for (ForceSample const& f : pass.wall_forces()) worst = std::max(worst, -f.x);
  fmt::print("steps {}, grains {}, nipped {}, largest overlap {:.2f} %, largest blade force {:.3g} mN\n", pass.steps(),
             pass.grains(), pass.nipped(), 100 * pass.largest_overlap(), 1e3 * worst);

  Simulation after(motion, rig(moved, 0), comm);
  after.scatter(bed);
  after.advance(steps(rest));
  dump(after.gather(), step + after.steps(), path("final.dump"));
}
}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int result = 0;
  try {
    if (argc < 2) throw InputError("usage: reference_spread OUT [SEED [TAG [sleep]]]");
    run(argv[1], argc > 2 ? std::stoull(argv[2]) : 1, argc > 3 ? argv[3] : "s1",
        argc > 4 && std::string(argv[4]) == "sleep");
  } catch (std::exception const& error) {
    fmt::print(stderr, "{}\n", error.what());
    result = 1;
  }
  MPI_Finalize();
  return result;
}
