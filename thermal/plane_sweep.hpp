#pragma once
// One pass over the memory for one balance of all cells. A plane of cells is looked up and balanced while it is in the
// cache: Theta exists for three planes only. Full cells between whole faces and gas need no shares and no capacity.
// Cold metal is left out. What is done with a cell's balance is a rule, chosen outside the loops.
#include <omp.h>

#include <algorithm>

#include "thermal/bulk_flow.hpp"
#include "thermal/heat_system.hpp"

namespace layerloop::thermal {

/// Moves to the first entry from `cell` on, in a list that ascends by cell. Mostly it is near.
template <class Iterator>
void skip_to(Iterator& at, Iterator end, std::int64_t cell) {
  using Entry = std::iter_value_t<Iterator>;
  std::iter_difference_t<Iterator> reach = 1;
  while (reach < end - at && at[reach].cell < cell) at += reach, reach *= 2;
  Iterator const last = at + std::min<std::iter_difference_t<Iterator>>(reach + 1, end - at);
  at = std::lower_bound(at, last, cell, [](Entry const& e, auto c) { return e.cell < c; });
}

/// A part of the planes along z, worked through upwards by one thread. A rule that updates the enthalpy in place needs
/// Theta of the planes just below and above looked up before any thread begins.
///
/// A rule: `begin_row(cells)` and `end_row(cells)` around every row; `single(cell, rate)` for what contacts, the far
/// field and the source bring to one cell, before the row's faces; `operator()(cell, rate)` for what its faces bring,
/// once a cell, in vectors; rates are dh/dt [J/(m^3 s)]. It returns the cell's new enthalpy.
template <class Rule>
class Slab {
 public:
  Slab(HeatSystem& system, std::span<CellPower const> source, Rule& rule, int begin, int end,
       std::vector<double>& theta)
      : system_(system),
        conduction_(system.conduction),
        flow_(conduction_),
        rule_(rule),
        begin_(begin),
        end_(end),
        vertical_(conduction_.liquid.acts() ? 4 : 0),
        theta_(theta),
        contact_(conduction_.contacts.begin()),
        far_(conduction_.far.begin()),
        source_(source.begin()),
        source_end_(source.end()) {
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

  HeatSystem& system_;
  Conduction const& conduction_;
  BulkFlow flow_;
  Rule& rule_;
  int begin_, end_;
  int vertical_;  ///< first plane for flows along z
  std::vector<double>& theta_;
  std::vector<ContactFace>::const_iterator contact_;
  std::vector<FarFace>::const_iterator far_;
  std::span<CellPower const>::iterator source_, source_end_;
};

template <class Rule>
void Slab<Rule>::look_up(int k) {
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

template <class Rule>
void Slab<Rule>::advance_row(std::size_t r, int k) {
  Row const row = system_.awake.stepped()[r];
  if (row.begin == row.end) return;
  UniformRow const& uniform = conduction_.uniform[r];
  std::int64_t const begin = std::clamp(uniform.begin, row.begin, row.end),
                     end = std::clamp(uniform.end, begin, row.end);
  rule_.begin_row(row);
  add_single_flows(row, vertical(k));
  double hottest = advance_uniform({begin, end}, uniform, k);
  for (Row const& part : {Row{row.begin, begin}, Row{end, row.end}}) hottest = std::max(hottest, advance_any(part, k));
  rule_.end_row(row, hottest);
}

/// Contacts, far field and source heat cell by cell, before the faces in between do.
template <class Rule>
void Slab<Rule>::add_single_flows(Row const& row, double const* theta) {
  skip_to(contact_, conduction_.contacts.end(), row.begin);
  for (; contact_ != conduction_.contacts.end() && contact_->cell < row.end; ++contact_) {
    auto const at = static_cast<std::size_t>(contact_ - conduction_.contacts.begin());
    rule_.single(contact_->cell, conduction_.per_capacity[contact_->cell] * system_.scratch.contact_flow[at]);
  }
  skip_to(far_, conduction_.far.end(), row.begin);
  for (; far_ != conduction_.far.end() && far_->cell < row.end; ++far_) {
    double const flow = far_->share * theta[far_->cell];
    rule_.single(far_->cell, -far_->per_capacity * flow);
    system_.scratch.far_flow[static_cast<std::size_t>(far_ - conduction_.far.begin())] = flow;
  }
  skip_to(source_, source_end_, row.begin);
  for (; source_ != source_end_ && source_->cell < row.end; ++source_) {
    rule_.single(source_->cell, conduction_.per_capacity[source_->cell] * (source_->watts / conduction_.cell));
  }
}

/// Full cells between whole faces and gas, in one loop. Where gas is, Theta is that of the cell itself, and no heat
/// flows. Returns their largest enthalpy [J/m^3].
template <class Rule>
double Slab<Rule>::advance_uniform(Row part, UniformRow const& uniform, int k) {
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
  double const full = conduction_.full_capacity();
  typename Rule::Cells const cells = rule_.cells();
  double hottest = 0;
#pragma omp simd reduction(max : hottest)
  for (std::int64_t c = part.begin; c < part.end; ++c) {
    double const t = here[c], v = here_z[c];
    double const along_x = (here[c - 1] - t) + (here[c + 1] - t);
    double const along_y = (low_y[c] - t) + (high_y[c] - t);
    double const along_z = (low_z[c] - v) + (high_z[c] - v);
    double const now = cells(c, full * (along_x + along_y + along_z));
    hottest = now > hottest ? now : hottest;
  }
  return hottest;
}

/// The same with every face's share and every cell's capacity. Where they are whole the bits are the same.
template <class Rule>
double Slab<Rule>::advance_any(Row const& part, int k) {
  auto const of = [](double const* theta) { return [theta](std::int64_t c) { return theta[c]; }; };
  auto const here = of(lateral(k)), low_z = of(vertical(k - 1)), here_z = of(vertical(k)), high_z = of(vertical(k + 1));
  typename Rule::Cells const cells = rule_.cells();
  double const* const per_capacity = conduction_.per_capacity.data();
  BulkFlow const flow = flow_;
  double hottest = 0;
#pragma omp simd reduction(max : hottest) if (part.end - part.begin > 8)
  for (std::int64_t c = part.begin; c < part.end; ++c) {
    double const now = cells(c, per_capacity[c] * flow(c, here, low_z, here_z, high_z));
    hottest = now > hottest ? now : hottest;
  }
  return hottest;
}

/// Flow through every contact [W/m], from the enthalpies before the step. Called by all threads, which wait at its end.
void contact_flows(HeatSystem& system);

/// First plane of every thread's slab, and the end of the last: about as many awake cells in each.
std::vector<int> share_out(HeatSystem const& system, int threads);

/// One pass: `rules` has one for every thread. Returns the heat flow to the far field [W]. \pre system.awake is up to
/// date
template <class Rule>
double sweep(HeatSystem& system, std::span<CellPower const> source, std::vector<Rule>& rules) {
  system.scratch.contact_flow.resize(system.conduction.contacts.size());
  system.scratch.far_flow.assign(system.conduction.far.size(), 0);
  system.scratch.theta.resize(std::max(system.scratch.theta.size(), rules.size()));
  std::vector<int> first_plane;
#pragma omp parallel num_threads(static_cast <int>(rules.size()))
  {
#pragma omp single
    first_plane = share_out(system, omp_get_num_threads());
    auto const t = static_cast<std::size_t>(omp_get_thread_num());
    Slab slab(system, source, rules[t], first_plane[t], first_plane[t + 1], system.scratch.theta[t]);
    slab.look_outside();
    contact_flows(system);  // ends with a barrier
    slab.advance();
  }
  double far = 0;
  double const* const flow = system.scratch.far_flow.data();
#pragma omp simd reduction(+ : far)
  for (std::size_t f = 0; f < system.scratch.far_flow.size(); ++f) far += flow[f];
  return far * system.conduction.cell;
}

/// Threads that a sweep can use.
inline std::size_t sweep_threads(HeatSystem const& system) {
  return static_cast<std::size_t>(std::min(omp_get_max_threads(), system.conduction.box.n[2]));
}

}  // namespace layerloop::thermal
