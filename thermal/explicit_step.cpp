// The explicit step as one pass over the memory. A plane of cells is looked up, balanced, heated, drained and recorded
// while it is in the cache: Theta exists for three planes only. Full cells between whole faces and gas need no shares
// and no capacity, so that a step reads and writes their enthalpy and their peak: 24 bytes. Cold metal is left out.
#include <omp.h>

#include <algorithm>

#include "thermal/bulk_flow.hpp"
#include "thermal/heat_system.hpp"

namespace layerloop::thermal {
namespace {

/// Moves to the first entry from `cell` on, in a list that ascends by cell.
template <class Iterator>
void skip_to(Iterator& at, Iterator end, std::int64_t cell) {
  using Entry = std::iter_value_t<Iterator>;
  if (at != end && at->cell < cell)
    at = std::lower_bound(at, end, cell, [](Entry const& e, auto c) { return e.cell < c; });
}

/// A part of the planes along z, worked through upwards by one thread. Enthalpy is updated in place, so Theta of the
/// planes just below and above is looked up before any thread begins.
class Slab {
 public:
  Slab(HeatSystem& system, std::span<CellPower const> source, double dt, int begin, int end, std::vector<double>& theta)
      : system_(system),
        conduction_(system.conduction),
        flow_(conduction_),
        dt_(dt),
        begin_(begin),
        end_(end),
        vertical_(conduction_.liquid.acts() ? 4 : 0),
        theta_(theta),
        contact_(conduction_.contacts.begin()),
        far_(conduction_.far.begin()),
        source_(source.begin()),
        source_end_(source.end()),
        open_(system.sink.cells.begin()) {
    theta_.resize(static_cast<std::size_t>((4 + vertical_) * conduction_.box.stride_z()));
  }

  void look_outside() {
    look_up(begin_ - 1);
    look_up(end_);
  }

  void advance() {
    look_up(begin_);
    for (int k = begin_; k < end_; ++k) {
      if (k + 1 < end_) look_up(k + 1);
      for (std::size_t r = conduction_.first_row[k]; r < conduction_.first_row[k + 1]; ++r) advance_row(r, k);
    }
  }

  std::vector<std::int64_t> newly_melted;

 private:
  /// Planes: three in turn and the one above the slab, of Theta as flows along x and y see it, then along z.
  double* lateral(int k) { return plane(k, 0); }
  double* vertical(int k) { return plane(k, vertical_); }
  double* plane(int k, int first) {  // local cell indices fit
    int const at = first + (k == end_ ? 3 : (k + 1) % 3);
    return theta_.data() + at * conduction_.box.stride_z() - conduction_.box.index(-1, -1, k);
  }

  void look_up(int k);
  void advance_row(std::size_t r, int k);
  void add_single_flows(Row const& row, double const* theta);
  double advance_uniform(Row part, UniformRow const& uniform, int k);
  double advance_any(Row const& part, int k);
  void drain_open_cells(std::vector<OpenCell>::iterator open);

  HeatSystem& system_;
  Conduction const& conduction_;
  BulkFlow flow_;
  double dt_;
  int begin_, end_;
  int vertical_;  ///< first plane for flows along z
  std::vector<double>& theta_;
  std::vector<float> peak_before_;  ///< of a row's open cells
  std::vector<ContactFace>::const_iterator contact_;
  std::vector<FarFace>::const_iterator far_;
  std::span<CellPower const>::iterator source_, source_end_;
  std::vector<OpenCell>::iterator open_;
};

void Slab::look_up(int k) {
  auto const& first = conduction_.first_row_with_neighbours;
  double const* const h = system_.enthalpy.data();
  EnthalpyTable const& table = system_.table;
  double const floor = system_.floor, theta_of_floor = floor > 0 ? table.conductivity_integral(floor) : 0;
  double* __restrict const theta = lateral(k);
  LiquidConductivity const liquid = conduction_.liquid;
  for (auto r = first[static_cast<std::size_t>(k + 1)]; r < first[static_cast<std::size_t>(k + 2)]; ++r) {
    Row const row = system_.awake.looked_up()[r];
#pragma omp simd
    for (std::int64_t c = row.begin; c < row.end; ++c) {
      double const value = table.conductivity_integral(h[c]) - theta_of_floor;
      theta[c] = h[c] > floor ? value : 0;
    }
    if (!liquid.acts()) continue;
    double* __restrict const along_z = vertical(k);
#pragma omp simd
    for (std::int64_t c = row.begin; c < row.end; ++c) {
      along_z[c] = liquid.enhanced(theta[c], liquid.vertical, liquid.liquidus - theta_of_floor);
      theta[c] = liquid.enhanced(theta[c], liquid.lateral, liquid.liquidus - theta_of_floor);
    }
  }
}

void Slab::advance_row(std::size_t r, int k) {
  Row const row = system_.awake.stepped()[r];
  if (row.begin == row.end) return;
  UniformRow const& uniform = conduction_.uniform[r];
  std::int64_t const begin = std::clamp(uniform.begin, row.begin, row.end),
                     end = std::clamp(uniform.end, begin, row.end);
  add_single_flows(row, vertical(k));
  skip_to(open_, system_.sink.cells.end(), row.begin);
  auto const first_open = open_;
  peak_before_.clear();
  for (; open_ != system_.sink.cells.end() && open_->cell < row.end; ++open_)
    peak_before_.push_back(system_.peak[static_cast<std::size_t>(open_->cell)]);
  double hottest = advance_uniform({begin, end}, uniform, k);
  for (Row const& part : {Row{row.begin, begin}, Row{end, row.end}}) hottest = std::max(hottest, advance_any(part, k));
  drain_open_cells(first_open);
  if (hottest >= system_.table.liquidus()) record_liquid(system_, row, dt_, newly_melted);
}

/// Contacts, far field and source heat cell by cell, before the faces in between do.
void Slab::add_single_flows(Row const& row, double const* theta) {
  auto const heat = [&](std::int64_t cell, double flow) {
    system_.enthalpy[cell] += dt_ * conduction_.per_capacity[cell] * flow;
  };
  skip_to(contact_, conduction_.contacts.end(), row.begin);
  for (; contact_ != conduction_.contacts.end() && contact_->cell < row.end; ++contact_) {
    heat(contact_->cell,
         system_.scratch.contact_flow[static_cast<std::size_t>(contact_ - conduction_.contacts.begin())]);
  }
  skip_to(far_, conduction_.far.end(), row.begin);
  for (; far_ != conduction_.far.end() && far_->cell < row.end; ++far_) {
    double const flow = far_->share * theta[far_->cell];
    system_.enthalpy[far_->cell] -= dt_ * far_->per_capacity * flow;
    system_.scratch.far_flow[static_cast<std::size_t>(far_ - conduction_.far.begin())] = flow;
  }
  skip_to(source_, source_end_, row.begin);
  for (; source_ != source_end_ && source_->cell < row.end; ++source_) {
    heat(source_->cell, source_->watts / conduction_.cell);
  }
}

/// Full cells between whole faces and gas, in one loop. Where gas is, Theta is that of the cell itself, and no heat
/// flows. Returns their largest enthalpy [J/m^3].
double Slab::advance_uniform(Row part, UniformRow const& uniform, int k) {
  if (part.begin == part.end) return 0;
  double* const theta = lateral(k);
  double const* const here_z = vertical(k);
  if (uniform.gas & UniformRow::low_x && part.begin == uniform.begin) theta[part.begin - 1] = theta[part.begin];
  if (uniform.gas & UniformRow::high_x && part.end == uniform.end) theta[part.end] = theta[part.end - 1];
  double const* const here = theta;
  double const* const low_y = here - (uniform.gas & UniformRow::low_y ? 0 : flow_.sy);
  double const* const high_y = here + (uniform.gas & UniformRow::high_y ? 0 : flow_.sy);
  double const* const low_z = uniform.gas & UniformRow::low_z ? here_z : vertical(k - 1) - flow_.sz;
  double const* const high_z = uniform.gas & UniformRow::high_z ? here_z : vertical(k + 1) + flow_.sz;
  double* __restrict const h = system_.enthalpy.data();
  float* __restrict const peak = system_.peak.data();
  double const full = dt_ * conduction_.full_capacity();
  double hottest = 0;
#pragma omp simd reduction(max : hottest)
  for (std::int64_t c = part.begin; c < part.end; ++c) {
    double const t = here[c], v = here_z[c];
    double const along_x = (here[c - 1] - t) + (here[c + 1] - t);
    double const along_y = (low_y[c] - t) + (high_y[c] - t);
    double const along_z = (low_z[c] - v) + (high_z[c] - v);
    double const now = h[c] + full * (along_x + along_y + along_z);
    float const single = static_cast<float>(now);
    h[c] = now;
    peak[c] = single > peak[c] ? single : peak[c];
    hottest = now > hottest ? now : hottest;
  }
  return hottest;
}

/// The same with every face's share and every cell's capacity. Where they are whole the bits are the same.
double Slab::advance_any(Row const& part, int k) {
  auto const of = [](double const* theta) { return [theta](std::int64_t c) { return theta[c]; }; };
  auto const here = of(lateral(k)), low_z = of(vertical(k - 1)), here_z = of(vertical(k)), high_z = of(vertical(k + 1));
  double* __restrict const h = system_.enthalpy.data();
  float* __restrict const peak = system_.peak.data();
  double const* const per_capacity = conduction_.per_capacity.data();
  BulkFlow const flow = flow_;
  double const dt = dt_;
  double hottest = 0;
#pragma omp simd reduction(max : hottest) if (part.end - part.begin > 8)
  for (std::int64_t c = part.begin; c < part.end; ++c) {
    double const now = h[c] + dt * per_capacity[c] * flow(c, here, low_z, here_z, high_z);
    float const single = static_cast<float>(now);
    h[c] = now;
    peak[c] = single > peak[c] ? single : peak[c];
    hottest = now > hottest ? now : hottest;
  }
  return hottest;
}

/// A peak counts after the surface has given off its heat.
void Slab::drain_open_cells(std::vector<OpenCell>::iterator open) {
  for (float const before : peak_before_) {
    auto const c = static_cast<std::size_t>(open->cell);
    double& h = system_.enthalpy[c];
    if (h > system_.floor) drain(system_.sink, *open, system_.table, dt_, h);
    system_.peak[c] = std::max(before, static_cast<float>(h));
    ++open;
  }
}

/// Flow through every contact [W/m], from the enthalpies before the step.
void contact_flows(HeatSystem& system) {
  std::vector<ContactFace> const& contacts = system.conduction.contacts;
  auto const temperature = [&](std::int64_t c) {
    return system.table.temperature(std::max(system.enthalpy[static_cast<std::size_t>(c)], system.floor));
  };
#pragma omp for
  for (std::size_t f = 0; f < contacts.size(); ++f) {
    ContactFace const& face = contacts[f];
    system.scratch.contact_flow[f] = face.conductivity * (temperature(face.neighbour) - temperature(face.cell));
  }
}

/// First plane of every thread's slab, and the end of the last: about as many awake cells in each.
std::vector<int> share_out(HeatSystem const& system, int threads) {
  auto const& first = system.conduction.first_row;
  std::vector<std::int64_t> until{0};
  for (std::size_t k = 0; k + 1 < first.size(); ++k) {
    std::int64_t cells = 0;
    for (std::size_t r = first[k]; r < first[k + 1]; ++r)
      cells += system.awake.stepped()[r].end - system.awake.stepped()[r].begin;
    until.push_back(until.back() + cells);
  }
  std::vector<int> begin;
  for (int t = 0; t < threads; ++t)
    begin.push_back(static_cast<int>(std::ranges::lower_bound(until, until.back() * t / threads) - until.begin()));
  begin.front() = 0;
  begin.push_back(static_cast<int>(until.size()) - 1);
  return begin;
}

}  // namespace

void explicit_step(HeatSystem& system, std::span<CellPower const> source, double dt) {
  std::vector<CellPower> sorted;
  if (!std::ranges::is_sorted(source, {}, &CellPower::cell)) {
    sorted.assign(source.begin(), source.end());
    std::ranges::stable_sort(sorted, {}, &CellPower::cell);
    source = sorted;
  }
  system.awake.update(system.conduction, system.grid, system.enthalpy, system.floor, source);
  system.scratch.contact_flow.resize(system.conduction.contacts.size());
  system.scratch.far_flow.assign(system.conduction.far.size(), 0);
  int const threads = std::min(omp_get_max_threads(), system.conduction.box.n[2]);
  std::vector<int> first_plane;
  system.scratch.theta.resize(std::max(system.scratch.theta.size(), static_cast<std::size_t>(threads)));
  std::vector<std::vector<std::int64_t>> newly_melted(static_cast<std::size_t>(threads));
#pragma omp parallel num_threads(threads)
  {
#pragma omp single
    first_plane = share_out(system, omp_get_num_threads());
    auto const t = static_cast<std::size_t>(omp_get_thread_num());
    Slab slab(system, source, dt, first_plane[t], first_plane[t + 1], system.scratch.theta[t]);
    slab.look_outside();
    contact_flows(system);  // ends with a barrier
    slab.advance();
    newly_melted[t] = std::move(slab.newly_melted);
  }
  double far = 0;
  for (double const flow : system.scratch.far_flow) far += flow;
  system.heat_to_far_field += dt * far * system.conduction.cell;
  system.grid.exchange(system.enthalpy);
  for (auto const& cells : newly_melted) join_melted(system, cells);
  join_melted(system, neighbours_that_melted(system));
}

}  // namespace layerloop::thermal
