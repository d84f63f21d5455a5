// The explicit step as one pass over the memory. A plane of cells is looked up, balanced, heated, drained and recorded
// while it is in the cache: Theta exists for three planes only, the balance for one row. Full cells inside metal need
// no shares and no capacity, so that a step reads and writes their enthalpy and their peak: 24 bytes.
#include <omp.h>

#include <algorithm>

#include "thermal/heat_system.hpp"

namespace layerloop::thermal {
namespace {

/// A part of the planes along z, worked through upwards by one thread. Enthalpy is updated in place, so Theta of the
/// planes just below and above is looked up before any thread begins.
class Slab {
 public:
  Slab(HeatSystem& system, std::span<CellPower const> source, double dt, int begin, int end,
       std::array<std::vector<double>, 4>& theta)
      : system_(system),
        conduction_(system.conduction),
        dt_(dt),
        begin_(begin),
        end_(end),
        theta_(theta),
        balance_(static_cast<std::size_t>(conduction_.box.stride_y())) {
    for (auto& plane : theta_) plane.resize(static_cast<std::size_t>(conduction_.box.stride_z()));
    auto const from = conduction_.box.index(-1, -1, begin);
    contact_ = std::ranges::lower_bound(conduction_.contacts, from, {}, &ContactFace::cell);
    far_ = std::ranges::lower_bound(conduction_.far, from, {}, &FarFace::cell);
    source_ = std::ranges::lower_bound(source, from, {}, &CellPower::cell);
    source_end_ = source.end();
    open_ = std::ranges::lower_bound(system.sink.cells, from, {}, &OpenCell::cell);
  }

  void look_outside() {
    look_up(begin_ - 1, plane(begin_ - 1));
    look_up(end_, theta_[3]);
  }

  void advance() {
    look_up(begin_, plane(begin_));
    for (int k = begin_; k < end_; ++k) {
      if (k + 1 < end_) look_up(k + 1, plane(k + 1));
      for (std::size_t r = conduction_.first_row[k]; r < conduction_.first_row[k + 1]; ++r) advance_row(r, k);
    }
  }

  std::vector<std::int64_t> newly_melted;

 private:
  std::vector<double>& plane(int k) { return theta_[static_cast<std::size_t>(k + 1) % 3]; }
  double const* theta_of(int k) {
    auto const& values = k == end_ ? theta_[3] : plane(k);
    return values.data() - conduction_.box.index(-1, -1, k);  // so that local cell indices fit
  }

  double* row_balance() { return balance_.data() - row_begin_; }  ///< so that local cell indices fit

  void look_up(int k, std::vector<double>& values);
  void advance_row(std::size_t r, int k);
  double advance_uniform(Row const& uniform, int k);
  void balance_faces(Row const& part, int k);
  void add_single_flows(Row const& row, double const* theta);
  void heat(Row const& part);

  HeatSystem& system_;
  Conduction const& conduction_;
  double dt_;
  int begin_, end_;
  std::array<std::vector<double>, 4>& theta_;  ///< three planes in turn, and the one above the slab
  std::int64_t row_begin_ = 0;
  std::vector<double> balance_;  ///< of one row [W/m]
  std::vector<ContactFace>::const_iterator contact_;
  std::vector<FarFace>::const_iterator far_;
  std::span<CellPower const>::iterator source_, source_end_;
  std::vector<OpenCell>::iterator open_;
};

void Slab::look_up(int k, std::vector<double>& values) {
  auto const& first = conduction_.first_row_with_neighbours;
  std::int64_t const corner = conduction_.box.index(-1, -1, k);
  double* __restrict const theta = values.data();
  double const* const h = system_.enthalpy.data() + corner;
  EnthalpyTable const& table = system_.table;
  for (auto r = first[static_cast<std::size_t>(k + 1)]; r < first[static_cast<std::size_t>(k + 2)]; ++r) {
    Row const& row = conduction_.rows_with_neighbours[r];
#pragma omp simd
    for (std::int64_t c = row.begin - corner; c < row.end - corner; ++c) {
      theta[c] = table.conductivity_integral(h[c]);
    }
  }
}

/// Inside the uniform stretch there are neither contacts nor open cells nor far faces; a source there sends the whole
/// row down the general way, which leaves the same bits.
void Slab::advance_row(std::size_t r, int k) {
  Row const& row = conduction_.rows[r];
  Row uniform = conduction_.uniform[r];
  row_begin_ = row.begin;
  auto const inside = std::find_if(source_, source_end_, [&](auto const& s) { return s.cell >= uniform.begin; });
  if (inside != source_end_ && inside->cell < uniform.end) uniform = {row.begin, row.begin};
  std::array<Row, 2> const rest{Row{row.begin, uniform.begin}, Row{uniform.end, row.end}};
  double hottest = advance_uniform(uniform, k);
  for (Row const& part : rest) balance_faces(part, k);
  add_single_flows(row, theta_of(k));
  for (Row const& part : rest) heat(part);
  for (; open_ != system_.sink.cells.end() && open_->cell < row.end; ++open_) {
    drain(system_.sink, *open_, system_.table, dt_, system_.enthalpy[static_cast<std::size_t>(open_->cell)]);
  }
  for (Row const& part : rest) hottest = std::max(hottest, record_peak(system_, part));
  if (hottest >= system_.table.liquidus()) record_liquid(system_, row, dt_, newly_melted);
}

/// Full cells between whole faces, in one loop. Returns their largest enthalpy [J/m^3].
double Slab::advance_uniform(Row const& uniform, int k) {
  double const *const below = theta_of(k - 1), *const here = theta_of(k), *const above = theta_of(k + 1);
  std::int64_t const sy = conduction_.box.stride_y(), sz = conduction_.box.stride_z();
  double* __restrict const h = system_.enthalpy.data();
  float* __restrict const peak = system_.peak.data();
  double const full = dt_ * conduction_.full_capacity();
  double hottest = 0;
#pragma omp simd reduction(max : hottest)
  for (std::int64_t c = uniform.begin; c < uniform.end; ++c) {
    double const t = here[c];
    double const along_x = (here[c - 1] - t) + (here[c + 1] - t);
    double const along_y = (here[c - sy] - t) + (here[c + sy] - t);
    double const along_z = (below[c - sz] - t) + (above[c + sz] - t);
    double const now = h[c] + full * (along_x + along_y + along_z);
    float const single = static_cast<float>(now);
    h[c] = now;
    peak[c] = single > peak[c] ? single : peak[c];
    hottest = now > hottest ? now : hottest;
  }
  return hottest;
}

/// The edges of a uniform stretch are single cells, which a vector's preparation would cost more than it saves.
/// The six flows are added in pairs, in one order for every cell: results depend neither on the ranks nor, mirrored, on
/// the side. Where shares are one they may be left out: the bits are the same.
void Slab::balance_faces(Row const& part, int k) {
  float const* const gx = conduction_.share_x.data();
  float const* const gy = conduction_.share_y.data();
  float const* const gz = conduction_.share_z.data();
  double const *const below = theta_of(k - 1), *const here = theta_of(k), *const above = theta_of(k + 1);
  std::int64_t const sy = conduction_.box.stride_y(), sz = conduction_.box.stride_z();
  double* __restrict const balance = row_balance();
#pragma omp simd if (part.end - part.begin > 8)
  for (std::int64_t c = part.begin; c < part.end; ++c) {
    double const t = here[c];
    double const along_x = gx[c - 1] * (here[c - 1] - t) + gx[c] * (here[c + 1] - t);
    double const along_y = gy[c - sy] * (here[c - sy] - t) + gy[c] * (here[c + sy] - t);
    double const along_z = gz[c - sz] * (below[c - sz] - t) + gz[c] * (above[c + sz] - t);
    balance[c] = along_x + along_y + along_z;
  }
}

/// Contacts, far field and source, cell by cell.
void Slab::add_single_flows(Row const& row, double const* theta) {
  double* const balance = row_balance();
  for (; contact_ != conduction_.contacts.end() && contact_->cell < row.end; ++contact_) {
    balance[contact_->cell] +=
        system_.scratch.contact_flow[static_cast<std::size_t>(contact_ - conduction_.contacts.begin())];
  }
  for (; far_ != conduction_.far.end() && far_->cell < row.end; ++far_) {
    double const flow = far_->share * theta[far_->cell];
    balance[far_->cell] -= flow;
    system_.scratch.far_flow[static_cast<std::size_t>(far_ - conduction_.far.begin())] = flow;
  }
  for (; source_ != source_end_ && source_->cell < row.end; ++source_) {
    balance[source_->cell] += source_->watts / conduction_.cell;
  }
}

void Slab::heat(Row const& part) {
  double* __restrict const h = system_.enthalpy.data();
  double const* const balance = row_balance();
  double const* const per_capacity = conduction_.per_capacity.data();
#pragma omp simd if (part.end - part.begin > 8)
  for (std::int64_t c = part.begin; c < part.end; ++c) h[c] += dt_ * per_capacity[c] * balance[c];
}

/// Flow through every contact [W/m], from the enthalpies before the step.
void contact_flows(HeatSystem& system) {
  std::vector<ContactFace> const& contacts = system.conduction.contacts;
  auto const temperature = [&](std::int64_t c) {
    return system.table.temperature(system.enthalpy[static_cast<std::size_t>(c)]);
  };
#pragma omp for
  for (std::size_t f = 0; f < contacts.size(); ++f) {
    ContactFace const& face = contacts[f];
    system.scratch.contact_flow[f] = face.conductivity * (temperature(face.neighbour) - temperature(face.cell));
  }
}

}  // namespace

void explicit_step(HeatSystem& system, std::span<CellPower const> source, double dt) {
  std::vector<CellPower> ascending(source.begin(), source.end());
  std::ranges::stable_sort(ascending, {}, &CellPower::cell);
  system.scratch.contact_flow.resize(system.conduction.contacts.size());
  system.scratch.far_flow.resize(system.conduction.far.size());
  int const planes = system.conduction.box.n[2], threads = std::min(omp_get_max_threads(), planes);
  system.scratch.theta.resize(std::max(system.scratch.theta.size(), static_cast<std::size_t>(threads)));
  std::vector<std::vector<std::int64_t>> newly_melted(static_cast<std::size_t>(threads));
#pragma omp parallel num_threads(threads)
  {
    int const t = omp_get_thread_num(), count = omp_get_num_threads();
    Slab slab(system, ascending, dt, planes * t / count, planes * (t + 1) / count,
              system.scratch.theta[static_cast<std::size_t>(t)]);
    slab.look_outside();
    contact_flows(system);  // ends with a barrier
    slab.advance();
    newly_melted[static_cast<std::size_t>(t)] = std::move(slab.newly_melted);
  }
  double far = 0;
  for (double const flow : system.scratch.far_flow) far += flow;
  system.heat_to_far_field += dt * far * system.conduction.cell;
  system.grid.exchange(system.enthalpy);
  for (auto const& cells : newly_melted) join_melted(system, cells);
  join_melted(system, neighbours_that_melted(system));
}

}  // namespace layerloop::thermal
