#include "dem/simulation.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/error.hpp"

namespace layerloop::dem {
namespace {
constexpr double skin_over_smallest_radius = 0.35;
constexpr std::size_t grains_a_thread = 400;  // fewer are not worth a barrier

struct Range {
  std::size_t from, to;
};

Range share(std::size_t n, int part, int parts) {
  auto const p = static_cast<std::size_t>(part), all = static_cast<std::size_t>(parts);
  return {n * p / all, n * (p + 1) / all};
}

double squared(double x, double y, double z) { return x * x + y * y + z * z; }

double farthest_reach(std::vector<ContactLaw> const& laws, double radius) {
  double reach = 0;
  for (ContactLaw const& law : laws) reach = std::max(reach, reach_gap(law, radius));
  return reach;
}

double stiffest(std::vector<ContactLaw> const& laws) {
  return std::ranges::max(laws, {}, &ContactLaw::normal_stiffness).normal_stiffness;
}
}  // namespace

Simulation::Simulation(Motion motion, Rig rig, Communicator const& communicator)
    : motion_(motion),
      rig_(std::move(rig)),
      communicator_(communicator),
      decomposition_(communicator, rig_.length),
      moving_walls_(rig_.walls, communicator),
      period_{rig_.length, rig_.width},
      laws_{law_form(motion_.contact), 1, {motion_.between_grains}, motion_.user},
      wall_laws_{motion_.at_walls} {
  if (motion_.mixture.density.empty()) return;
  laws_.materials = static_cast<std::int32_t>(motion_.mixture.materials());
  laws_.laws = motion_.mixture.between_grains;
  wall_laws_ = motion_.mixture.at_walls;
}

void Simulation::scatter(PowderBed const& bed) {
  grains_.clear();
  first_springs_ = bed.contacts;
  steps_ = next_sink_check_ = next_sleep_check_ = rebuilds_ = nipped_ = 0;
  largest_overlap_ = 0;
  moving_walls_.start();
  phases_ = {};
  watch_ = {};
  if (bed.size() == 0) throw InputError("there is no grain to move (the bed is empty) raise powder.particles");
  auto const [first, last] = std::ranges::minmax(bed.material);
  if (laws_.materials > 1 && (first < 0 || last >= laws_.materials))
    throw InputError(fmt::format("the bed has a grain of material {} (there are materials 0 to {}) give it one of them",
                                 first < 0 ? first : last, laws_.materials - 1));
  auto const [smallest, largest] = std::ranges::minmax(bed.radius);
  smallest_radius_ = smallest;
  largest_radius_ = largest;
  skin_ = skin_over_smallest_radius * smallest;
  wall_reach_ = farthest_reach(wall_laws_, largest);
  reach_ = std::max(farthest_reach(laws_.laws, largest), wall_reach_);
  if (rig_.width < 4 * largest + 2 * (skin_ + reach_)) {
    throw InputError(
        fmt::format("the bed is {:.3g} um wide (a grain of {:.3g} um would meet itself around the period) "
                    "make machine.width at least {:.3g} um",
                    rig_.width * 1e6, 2e6 * largest, 4.2e6 * largest + 2e6 * (skin_ + reach_)));
  }
  if (rig_.length < 4 * largest + 2 * (skin_ + reach_))
    throw InputError("the period along x is shorter than two grains (a grain would meet itself) use a longer one");
  unit_ = ActionUnit(std::max(stiffest(laws_.laws), stiffest(wall_laws_)), largest);
  mesh_grids_ = grids_of(rig_.walls, 2 * largest);
  Range const own = share(bed.size(), communicator_.rank(), communicator_.size());
  for (std::size_t i = own.from; i < own.to; ++i) {
    grains_.push_back(record_of(bed, i, motion_.density_of(bed.material[i])));
  }
  grains_.owned = grains_.size();
  grain_count_ = static_cast<std::int64_t>(bed.size());
  neighbours_ = {};
  shares_.clear();
  wall_contacts_ = {};
  if (Fault const lost = find_lost_grain(); communicator_.any(!lost.text.empty())) fail(lost);
  rebuild();
  check_first_overlaps();
  open_energy_ledger();
}

void Simulation::append_all_springs(std::vector<LocalSpring>& springs) const {
  for (Share const& share : shares_) append_springs(share.near, neighbours_, grains_, springs);
  append_springs(wall_contacts_, grains_, springs);
}

std::vector<std::int64_t> Simulation::loads() const {
  std::vector<std::int64_t> load(grains_.owned, 1);
  if (neighbours_.begin.size() != grains_.owned + 1) return load;  // before the first list
  for (std::size_t i = 0; i < grains_.owned; ++i) {
    if (!is_asleep(grains_.quiet[i])) load[i] += 2 + neighbours_.begin[i + 1] - neighbours_.begin[i];
  }
  return load;
}

void Simulation::rebuild() {
  PhaseClock clock;
  std::vector<LocalSpring> local;
  append_all_springs(local);
  std::vector<GrainRecord> records(grains_.owned);
  for (std::size_t i = 0; i < records.size(); ++i) records[i] = grains_.record(i);
  bool const first = rebuilds_++ == 0;  // springs come from the bed then, and every rank has them all
  std::vector<ContactSpring> springs;
  decomposition_.redistribute(records, loads(), local, springs);
  if (first) springs = std::move(first_springs_);
  std::erase_if(records, [](GrainRecord const& r) { return r.leaves != 0; });

  double const cell = 2 * largest_radius_;  // neighbours in space are neighbours in memory
  auto const place = [&](GrainRecord const& r) {
    return std::tuple(std::floor(r.state.y / (8 * cell)), std::floor(r.state.x / cell), std::floor(r.state.z / cell),
                      r.state.y, r.id);
  };
  std::ranges::sort(records, {}, place);
  grains_.clear();
  for (GrainRecord const& record : records) grains_.push_back(record);
  records = {};  // many bytes a grain: given back before the neighbours need them
  grains_.owned = grains_.size();
  decomposition_.add_ghosts(grains_, 2 * largest_radius_ + skin_ + reach_);
  grains_.close();

  build_neighbours(neighbours_, grains_, skin_ + reach_, period_, springs);
  build_wall_contacts(wall_contacts_, grains_, scene(), mesh_grids_, skin_ + reach_, springs);
  wall_entry_.assign(grains_.owned, -1);
  for (std::size_t w = 0; w < wall_contacts_.grain.size(); ++w)
    wall_entry_[static_cast<std::size_t>(wall_contacts_.grain[w])] = static_cast<std::int32_t>(w);
  x_built_.resize(grains_.owned);
  y_built_.resize(grains_.owned);
  z_built_.resize(grains_.owned);
  for (std::size_t i = 0; i < grains_.owned; ++i) {
    x_built_[i] = grains_[i].x;
    y_built_[i] = grains_[i].y;
    z_built_[i] = grains_[i].z;
  }
  moving_walls_.mark();

  int const cores = std::max(1, omp_get_num_procs() / decomposition_.ranks_on_node());
  team_.allow(std::clamp(static_cast<int>(grains_.owned / grains_a_thread), 1, std::min(omp_get_max_threads(), cores)));
  shares_.clear();
  share_out(team_.threads());
  clock.add_to(phases_.neighbours);
}

void Simulation::set_gravity(Vec3 const& gravity) {
  if (motion_.grains_sleep || motion_.keeps_energy_ledger)
    throw std::logic_error("gravity may turn only where no grain sleeps and no ledger of energy is kept");
  rig_.gravity = gravity;
}

PowderBed Simulation::gather() {
  std::vector<LocalSpring> local;
  append_all_springs(local);
  std::vector<ContactSpring> springs;
  for (LocalSpring const& spring : local) {
    if (static_cast<std::size_t>(spring.row_a) < grains_.owned) springs.push_back(spring.spring);
  }
  std::vector<GrainRecord> records(grains_.owned);
  for (std::size_t i = 0; i < records.size(); ++i) records[i] = grains_.record(i);
  records = communicator_.all_gather(records);
  std::ranges::sort(records, {}, &GrainRecord::id);

  PowderBed bed;
  for (GrainRecord const& r : records) {
    GrainState const& g = r.state;
    bed.add(r.id, {g.x, g.y, g.z}, g.radius, r.material);
    bed.vx.back() = g.vx;
    bed.vy.back() = g.vy;
    bed.vz.back() = g.vz;
    bed.wx.back() = g.wx;
    bed.wy.back() = g.wy;
    bed.wz.back() = g.wz;
  }
  bed.contacts = communicator_.all_gather(springs);
  sort_springs(bed.contacts);
  return bed;
}

std::int64_t Simulation::count_faster_than(double speed) const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < grains_.owned; ++i)
    count += squared(grains_[i].vx, grains_[i].vy, grains_[i].vz) > speed * speed;
  return communicator_.sum(count);
}

std::int64_t Simulation::touching_pairs() const {
  std::int64_t count = 0;  // a pair across a border stands on both of its ranks: counted where its lower id is at home
  for (Share const& share : shares_) count += count_touching(share.near, neighbours_, grains_.owned);
  return communicator_.sum(count);
}

std::int64_t Simulation::sleeping() const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < grains_.owned; ++i) count += is_asleep(grains_.quiet[i]);
  return communicator_.sum(count);
}

double Simulation::coordination() const {
  return 2.0 * static_cast<double>(touching_pairs()) / static_cast<double>(grain_count_);
}

}  // namespace layerloop::dem
