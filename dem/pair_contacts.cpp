#include "dem/pair_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::dem {
namespace {

/// Rows sorted into cells at least as large as the reach of a pair.
struct Cells {
  double x0, z0, size, size_y;
  std::int32_t nx, ny, nz;
  std::vector<std::int32_t> begin, rows;

  std::int32_t column(double x) const { return static_cast<std::int32_t>((x - x0) / size); }
  std::int32_t layer(double z) const { return static_cast<std::int32_t>((z - z0) / size); }
  std::int32_t strip(double y) const { return std::clamp(static_cast<std::int32_t>(y / size_y), 0, ny - 1); }
  std::size_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>((i * std::int64_t{nz} + k) * ny + j);
  }
};

Cells sort_into_cells(Grains const& g, double reach, double period) {
  auto const [x_low, x_high] = std::ranges::minmax(g.x);
  auto const [z_low, z_high] = std::ranges::minmax(g.z);
  Cells cells{
      .x0 = x_low, .z0 = z_low, .size = reach, .size_y = period, .nx = 0, .ny = 1, .nz = 0, .begin = {}, .rows = {}};
  cells.nx = cells.column(x_high) + 1;
  cells.nz = cells.layer(z_high) + 1;
  if (period >= 3 * reach) {  // fewer than three strips would meet themselves around the period
    cells.ny = static_cast<std::int32_t>(std::min(period / reach, 1e3));
    cells.size_y = period / cells.ny;
  }
  std::vector<std::size_t> cell(g.size());
  cells.begin.assign(static_cast<std::size_t>(cells.nx) * static_cast<std::size_t>(cells.ny * cells.nz) + 1, 0);
  for (std::size_t i = 0; i < g.size(); ++i) {
    cell[i] = cells.index(cells.column(g.x[i]), cells.strip(g.y[i]), cells.layer(g.z[i]));
    ++cells.begin[cell[i] + 1];
  }
  for (std::size_t c = 1; c < cells.begin.size(); ++c) cells.begin[c] += cells.begin[c - 1];
  std::vector<std::int32_t> next(cells.begin.begin(), cells.begin.end() - 1);
  cells.rows.resize(g.size());
  for (std::size_t i = 0; i < g.size(); ++i)
    cells.rows[static_cast<std::size_t>(next[cell[i]]++)] = static_cast<std::int32_t>(i);
  return cells;
}

double wrapped(double dy, double period) {
  double const half = 0.5 * period;
  return dy > half ? dy - period : (dy < -half ? dy + period : dy);
}

/// Adds the pairs of owned grain `a` with later owned grains and with ghosts.
void add_pairs_of(PairContacts& pairs, Grains const& g, Cells const& cells, std::size_t a, double skin, double period) {
  std::int32_t const i = cells.column(g.x[a]), j = cells.strip(g.y[a]), k = cells.layer(g.z[a]);
  std::int32_t const dj = cells.ny > 1 ? 1 : 0;
  for (std::int32_t ci = std::max(i - 1, 0); ci <= std::min(i + 1, cells.nx - 1); ++ci)
    for (std::int32_t ck = std::max(k - 1, 0); ck <= std::min(k + 1, cells.nz - 1); ++ck)
      for (std::int32_t cj = j - dj; cj <= j + dj; ++cj) {
        std::size_t const c = cells.index(ci, (cj + cells.ny) % cells.ny, ck);
        for (std::int32_t at = cells.begin[c]; at < cells.begin[c + 1]; ++at) {
          auto const b = static_cast<std::size_t>(cells.rows[static_cast<std::size_t>(at)]);
          if (b <= a) continue;
          double const dx = g.x[a] - g.x[b], dy = wrapped(g.y[a] - g.y[b], period), dz = g.z[a] - g.z[b];
          double const reach = g.radius[a] + g.radius[b] + skin;
          if (dx * dx + dy * dy + dz * dz >= reach * reach) continue;
          bool const ascending = g.id[a] < g.id[b];
          pairs.first.push_back(static_cast<std::int32_t>(ascending ? a : b));
          pairs.second.push_back(static_cast<std::int32_t>(ascending ? b : a));
        }
      }
}

void fill_pair_constants(PairContacts& pairs, Grains const& g, std::vector<ContactSpring> const& springs) {
  std::size_t const n = pairs.size();
  for (auto* values : {&pairs.radius_sum, &pairs.reduced_radius, &pairs.reduced_mass, &pairs.inverse_diameter,
                       &pairs.spring_x, &pairs.spring_y, &pairs.spring_z})
    values->assign(n, 0.0);
  pairs.touching.assign(n, 0);
  pairs.action.assign(n, 0);
  pairs.actions.assign(n + 1, PairAction{});
  for (std::size_t k = 0; k < n; ++k) {
    auto const i = static_cast<std::size_t>(pairs.first[k]), j = static_cast<std::size_t>(pairs.second[k]);
    pairs.radius_sum[k] = g.radius[i] + g.radius[j];
    pairs.reduced_radius[k] = g.radius[i] * g.radius[j] / pairs.radius_sum[k];
    pairs.reduced_mass[k] = g.mass[i] * g.mass[j] / (g.mass[i] + g.mass[j]);
    pairs.inverse_diameter[k] = 0.5 / std::min(g.radius[i], g.radius[j]);
    if (ContactSpring const* old = find_spring(springs, g.id[i], g.id[j])) {
      pairs.touching[k] = -1;
      pairs.spring_x[k] = old->spring[0];
      pairs.spring_y[k] = old->spring[1];
      pairs.spring_z[k] = old->spring[2];
    }
  }
}

void list_pairs_by_grain(PairContacts& pairs, Grains const& g) {
  pairs.begin.assign(g.owned + 1, 0);
  auto const for_each_side = [&](auto&& visit) {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if (static_cast<std::size_t>(pairs.first[k]) < g.owned) visit(static_cast<std::size_t>(pairs.first[k]), 2 * k);
      if (static_cast<std::size_t>(pairs.second[k]) < g.owned)
        visit(static_cast<std::size_t>(pairs.second[k]), 2 * k + 1);
    }
  };
  for_each_side([&](std::size_t row, std::size_t) { ++pairs.begin[row + 1]; });
  for (std::size_t i = 0; i < g.owned; ++i) pairs.begin[i + 1] += pairs.begin[i];
  pairs.entries.resize(static_cast<std::size_t>(pairs.begin[g.owned]));
  std::vector<std::int32_t> next(pairs.begin.begin(), pairs.begin.end() - 1);
  for_each_side([&](std::size_t row, std::size_t entry) {
    pairs.entries[static_cast<std::size_t>(next[row]++)] = static_cast<std::int32_t>(entry);
  });
  auto const partner_id = [&](std::int32_t entry) {
    auto const& partner = entry & 1 ? pairs.first : pairs.second;
    return g.id[static_cast<std::size_t>(partner[static_cast<std::size_t>(entry >> 1)])];
  };
  for (std::size_t i = 0; i < g.owned; ++i) {
    std::sort(pairs.entries.begin() + pairs.begin[i], pairs.entries.begin() + pairs.begin[i + 1],
              [&](std::int32_t a, std::int32_t b) { return partner_id(a) < partner_id(b); });
  }
}

constexpr std::size_t block = 512;  // pairs at a time: what the two passes share stays in the first-level cache

}  // namespace

void build_pairs(PairContacts& pairs, Grains const& grains, double skin, double period,
                 std::vector<ContactSpring> const& springs) {
  pairs.first.clear();
  pairs.second.clear();
  if (grains.size() > 0) {
    double const largest = *std::ranges::max_element(grains.radius);
    Cells const cells = sort_into_cells(grains, 2 * largest + skin, period);
    for (std::size_t a = 0; a < grains.owned; ++a) add_pairs_of(pairs, grains, cells, a, skin, period);
  }
  fill_pair_constants(pairs, grains, springs);
  list_pairs_by_grain(pairs, grains);
}

void append_springs(PairContacts const& pairs, Grains const& grains, std::vector<LocalSpring>& springs) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (!pairs.touching[k]) continue;
    std::int32_t const i = pairs.first[k], j = pairs.second[k];
    springs.push_back({{grains.id[static_cast<std::size_t>(i)],
                        grains.id[static_cast<std::size_t>(j)],
                        {pairs.spring_x[k], pairs.spring_y[k], pairs.spring_z[k]}},
                       i,
                       j});
  }
}

namespace {

/// Pairs [start, start + count) that touch, in order; gives each its row of actions.
/// \param contact  room for `count` pairs
/// \return number of touching pairs
std::int32_t find_touching(PairContacts& pairs, Grains const& grains, double period, std::int32_t start,
                           std::int32_t count, std::int32_t* __restrict touches, std::int32_t* __restrict contact) {
  double const* __restrict x = grains.x.data(), * __restrict y = grains.y.data(), * __restrict z = grains.z.data();
  std::int32_t const* __restrict first = pairs.first.data(), * __restrict second = pairs.second.data();
  double const* __restrict radius_sum = pairs.radius_sum.data();
  std::int32_t* __restrict action = pairs.action.data();
  double const half = 0.5 * period;
#pragma omp simd
  for (std::int32_t l = 0; l < count; ++l) {
    std::int32_t const k = start + l, i = first[k], j = second[k];
    double const dx = x[i] - x[j], dz = z[i] - z[j];
    double dy = y[i] - y[j];
    dy = dy > half ? dy - period : (dy < -half ? dy + period : dy);
    touches[l] = dx * dx + dy * dy + dz * dz < radius_sum[k] * radius_sum[k] ? -1 : 0;
  }
  std::int32_t contacts = 0;
  for (std::int32_t l = 0; l < count; ++l) {  // no branch: which pairs touch cannot be predicted
    contact[contacts] = start + l;
    action[start + l] = touches[l] & (start + 1 + contacts);
    contacts -= touches[l];
  }
  return contacts;
}

/// Forces of the listed pairs, all at once.
/// \return largest overlap over the smaller grain's diameter
double act_on(PairContacts& pairs, Grains const& g, ContactLaw const law, double period, double dt,
              std::int32_t const* __restrict contact, std::int32_t contacts, PairAction* __restrict action) {
  double const* __restrict x = g.x.data(), * __restrict y = g.y.data(), * __restrict z = g.z.data();
  double const* __restrict vx = g.vx.data(), * __restrict vy = g.vy.data(), * __restrict vz = g.vz.data();
  double const* __restrict wx = g.wx.data(), * __restrict wy = g.wy.data(), * __restrict wz = g.wz.data();
  double const* __restrict radius = g.radius.data();
  std::int32_t const* __restrict first = pairs.first.data(), * __restrict second = pairs.second.data();
  double const* __restrict radius_sum = pairs.radius_sum.data(), * __restrict reduced_radius =
                                                                     pairs.reduced_radius.data();
  double const* __restrict reduced_mass = pairs.reduced_mass.data(), * __restrict inverse_diameter =
                                                                         pairs.inverse_diameter.data();
  double *__restrict spring_x = pairs.spring_x.data(), *__restrict spring_y = pairs.spring_y.data(),
         *__restrict spring_z = pairs.spring_z.data();
  std::int32_t const* __restrict touching = pairs.touching.data();
  double const half = 0.5 * period;
  double worst = 0;
#pragma omp simd reduction(max : worst)
  for (std::int32_t l = 0; l < contacts; ++l) {
    std::int32_t const k = contact[l], i = first[k], j = second[k];
    double const dx = x[i] - x[j], dz = z[i] - z[j];
    double dy = y[i] - y[j];
    dy = dy > half ? dy - period : (dy < -half ? dy + period : dy);
    double const distance = std::sqrt(dx * dx + dy * dy + dz * dz), inverse = 1 / distance;
    double const overlap = radius_sum[k] - distance;
    double const arm_i = radius[i] - 0.5 * overlap, arm_j = radius[j] - 0.5 * overlap;
    bool const had = touching[k] != 0;
    ContactAction const a =
        act(law,
            {overlap, reduced_radius[k], reduced_mass[k], dx * inverse, dy * inverse, dz * inverse, vx[i] - vx[j],
             vy[i] - vy[j], vz[i] - vz[j], arm_i * wx[i] + arm_j * wx[j], arm_i * wy[i] + arm_j * wy[j],
             arm_i * wz[i] + arm_j * wz[j], wx[i] - wx[j], wy[i] - wy[j], wz[i] - wz[j], had ? spring_x[k] : 0.0,
             had ? spring_y[k] : 0.0, had ? spring_z[k] : 0.0},
            dt);
    spring_x[k] = a.spring_x;
    spring_y[k] = a.spring_y;
    spring_z[k] = a.spring_z;
    action[l].force = {a.fx, a.fy, a.fz, 0.0};
    action[l].torque_first = {-arm_i * a.qx - a.rx, -arm_i * a.qy - a.ry, -arm_i * a.qz - a.rz, 0.0};
    action[l].torque_second = {a.rx - arm_j * a.qx, a.ry - arm_j * a.qy, a.rz - arm_j * a.qz, 0.0};
    double const relative = overlap * inverse_diameter[k];
    worst = relative > worst ? relative : worst;
  }
  return worst;
}

}  // namespace

double evaluate_pairs(PairContacts& pairs, Grains const& grains, ContactLaw const& law, double period, double dt,
                      std::size_t from, std::size_t to) {
  alignas(64) std::int32_t touches[block];  // -1: yes, 0: no
  alignas(64) std::int32_t contact[block];
  double worst = 0;
  for (std::size_t at = from; at < to; at += block) {
    auto const start = static_cast<std::int32_t>(at), count = static_cast<std::int32_t>(std::min(block, to - at));
    std::int32_t const contacts = find_touching(pairs, grains, period, start, count, touches, contact);
    worst =
        std::max(worst, act_on(pairs, grains, law, period, dt, contact, contacts, pairs.actions.data() + start + 1));
    std::copy_n(touches, count, pairs.touching.begin() + start);
  }
  return worst;
}

}  // namespace layerloop::dem
