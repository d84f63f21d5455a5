#include "thermal/conduction.hpp"

#include <algorithm>
#include <cmath>

#include "thermal/bulk_flow.hpp"

namespace layerloop::thermal {
namespace {

constexpr int directions[6][2] = {{0, -1}, {0, 1}, {1, -1}, {1, 1}, {2, -1}, {2, 1}};  // axis, step

std::int64_t stride(LocalBox const& box, int axis) {
  return axis == 0 ? 1 : axis == 1 ? box.stride_y() : box.stride_z();
}

/// Cell of the grid behind local coordinates; -1 outside.
std::int64_t grid_cell(HeatCells const& cells, LocalBox const& box, std::int32_t i, std::int32_t j, std::int32_t k) {
  std::array<std::int32_t, 3> c{box.begin[0] + i, box.begin[1] + j, box.begin[2] + k};
  if (cells.side_y == SideY::periodic) c[1] = (c[1] + cells.grid.n[1]) % cells.grid.n[1];
  for (std::size_t a = 0; a < 3; ++a) {
    if (c[a] < 0 || c[a] >= cells.grid.n[a]) return -1;
  }
  return cells.grid.index(c[0], c[1], c[2]);
}

std::vector<float>& face_share(Conduction& conduction, int axis) {
  return axis == 0 ? conduction.share_x : axis == 1 ? conduction.share_y : conduction.share_z;
}

float shared(Conduction const& conduction, std::int64_t a, std::int64_t b) {
  return conduction.fill[a] == 0 || conduction.fill[b] == 0
             ? 0
             : std::min(1.0f, 0.5f * (conduction.fill[a] + conduction.fill[b]));
}

/// Rows of `box` enlarged by `layer` cells, cut to where the metal begins and ends.
std::vector<Row> rows_with_metal(Conduction const& conduction, std::int32_t layer, std::vector<std::size_t>& first) {
  LocalBox const& box = conduction.box;
  std::vector<Row> rows;
  for (std::int32_t k = -layer; k < box.n[2] + layer; ++k) {
    first.push_back(rows.size());
    for (std::int32_t j = -layer; j < box.n[1] + layer; ++j) {
      Row row{box.index(-layer, j, k), box.index(box.n[0] + layer, j, k)};
      while (row.begin < row.end && conduction.fill[row.begin] == 0) ++row.begin;
      while (row.begin < row.end && conduction.fill[row.end - 1] == 0) --row.end;
      if (row.begin < row.end) rows.push_back(row);
    }
  }
  first.push_back(rows.size());
  return rows;
}

/// Sides of a cell that are turned to gas, when it is full and its other faces are whole; 255 for other cells.
std::uint8_t gas_sides(Conduction const& conduction, std::int64_t c) {
  constexpr std::uint8_t not_uniform = 255;
  if (conduction.per_capacity[c] != conduction.full_capacity()) return not_uniform;
  std::uint8_t gas = 0, side = UniformRow::low_x;
  for (auto const& [axis, step] : directions) {
    std::int64_t const next = c + step * stride(conduction.box, axis);
    std::vector<float> const& share = axis == 0   ? conduction.share_x
                                      : axis == 1 ? conduction.share_y
                                                  : conduction.share_z;
    if (conduction.fill[next] == 0) {
      gas |= side;
    } else if (share[step < 0 ? next : c] != 1) {
      return not_uniform;
    }
    side = static_cast<std::uint8_t>(side << 1);
  }
  return gas;
}

UniformRow longest_uniform(Conduction const& conduction, Row const& row) {
  constexpr std::uint8_t along_x = UniformRow::low_x | UniformRow::high_x;
  UniformRow longest{{row.begin, row.begin}, 0};
  for (std::int64_t begin = row.begin, end; begin < row.end; begin = end) {
    std::uint8_t gas = gas_sides(conduction, begin);
    end = begin + 1;
    if (gas == 255) continue;
    while (!(gas & UniformRow::high_x) && end < row.end) {
      std::uint8_t const next = gas_sides(conduction, end);
      if (next == 255 || ((next ^ gas) & ~along_x)) break;
      gas |= next;
      ++end;
    }
    if (end - begin > longest.end - longest.begin) longest = {{begin, end}, gas};
  }
  return longest;
}

std::vector<std::int64_t> neighbours_with_metal(Conduction const& conduction) {
  LocalBox const& box = conduction.box;
  std::vector<std::int64_t> cells;
  for (std::int32_t k = -1; k <= box.n[2]; ++k) {
    for (std::int32_t j = -1; j <= box.n[1]; ++j) {
      bool const own_row = k >= 0 && k < box.n[2] && j >= 0 && j < box.n[1];
      for (std::int32_t i = -1; i <= box.n[0]; i += own_row ? box.n[0] + 1 : 1) {
        if (conduction.fill[box.index(i, j, k)] > 0) cells.push_back(box.index(i, j, k));
      }
    }
  }
  return cells;
}

/// Bodies of all local cells, and the fill that goes with them.
std::vector<std::int32_t> copy_cells(Conduction& conduction, HeatCells const& cells) {
  LocalBox const& box = conduction.box;
  std::vector<std::int32_t> body(static_cast<std::size_t>(box.size()), -1);
  conduction.fill.assign(body.size(), 0);
  conduction.per_capacity.assign(body.size(), 0);
  for (std::int32_t k = -1; k <= box.n[2]; ++k) {
    for (std::int32_t j = -1; j <= box.n[1]; ++j) {
      for (std::int32_t i = -1; i <= box.n[0]; ++i) {
        std::int64_t const c = grid_cell(cells, box, i, j, k);
        if (c < 0 || cells.fill[c] == 0) continue;
        std::int64_t const at = box.index(i, j, k);
        conduction.fill[at] = static_cast<float>(cells.fill[c]);
        conduction.per_capacity[at] = 1 / (cells.fill[c] * conduction.cell * conduction.cell);
        body[at] = cells.body[c];
      }
    }
  }
  return body;
}

/// Faces between an own cell and its six neighbours.
void add_faces(Conduction& conduction, std::vector<std::int32_t> const& body, std::int64_t at, double bulk,
               ContactLaw const& contact) {
  for (auto const& [axis, step] : directions) {
    std::int64_t const next = at + step * stride(conduction.box, axis);
    if (conduction.fill[next] == 0) continue;
    if (body[at] == body[next]) {
      face_share(conduction, axis)[step < 0 ? next : at] = shared(conduction, at, next);
    } else {
      double const layer = contact(body[at], body[next]), series = layer > 0 ? 1 / (1 / bulk + 1 / layer) : 0;
      conduction.contacts.push_back({at, next, series * shared(conduction, at, next)});
    }
  }
}

/// Faces of an own cell of consolidated metal on the sides of the grid that heat may leave through.
void add_far_faces(Conduction& conduction, HeatCells const& cells, std::array<std::int32_t, 3> const& c,
                   FarField const& far) {
  auto const add = [&](double distance) {
    double const fill = std::min(1.0, cells.fill[static_cast<std::size_t>(cells.grid.index(c[0], c[1], c[2]))]);
    double const share = fill * conduction.cell / (distance + 0.5 * conduction.cell);
    std::int64_t const own = conduction.box.own(c);
    if (share > 0) conduction.far.push_back({own, share, conduction.per_capacity[own]});
  };
  for (auto const& [axis, step] : directions) {
    auto const a = static_cast<std::size_t>(axis);
    if (c[a] != (step < 0 ? 0 : cells.grid.n[a] - 1)) continue;
    if (axis == 0 || (axis == 1 && cells.side_y == SideY::far_field)) add(far.sides);
    if (axis == 2 && step < 0) add(far.bottom);
  }
}

}  // namespace

void Conduction::melt(std::int64_t cell_index) {
  for (auto const& [axis, step] : directions) {
    std::int64_t const next = cell_index + step * stride(box, axis);
    if (next < 0 || next >= box.size()) continue;
    if (fill[next] == 0) continue;
    face_share(*this, axis)[step < 0 ? next : cell_index] = shared(*this, cell_index, next);
    for (auto const& [a, b] : {std::pair{cell_index, next}, std::pair{next, cell_index}}) {
      auto face = std::ranges::lower_bound(contacts, a, {}, &ContactFace::cell);
      for (; face != contacts.end() && face->cell == a; ++face) {
        if (face->neighbour == b) face->conductivity = 0;
      }
    }
  }
}

Conduction make_conduction(HeatCells const& cells, LocalBox const& box, FarField const& far, double bulk_conductivity,
                           ContactLaw const& contact_conductivity) {
  Conduction conduction;
  conduction.box = box;
  conduction.cell = cells.grid.cell;
  std::vector<std::int32_t> const body = copy_cells(conduction, cells);
  for (int axis = 0; axis < 3; ++axis) face_share(conduction, axis).assign(body.size(), 0);
  for (std::int32_t k = 0; k < box.n[2]; ++k) {
    for (std::int32_t j = 0; j < box.n[1]; ++j) {
      for (std::int32_t i = 0; i < box.n[0]; ++i) {
        std::int64_t const at = box.index(i, j, k);
        if (conduction.fill[at] == 0) continue;
        add_faces(conduction, body, at, bulk_conductivity, contact_conductivity);
        if (body[at] < 0) add_far_faces(conduction, cells, {box.begin[0] + i, box.begin[1] + j, box.begin[2] + k}, far);
      }
    }
  }
  conduction.rows = rows_with_metal(conduction, 0, conduction.first_row);
  conduction.rows_with_neighbours = rows_with_metal(conduction, 1, conduction.first_row_with_neighbours);
  for (Row const& row : conduction.rows) conduction.uniform.push_back(longest_uniform(conduction, row));
  conduction.neighbours = neighbours_with_metal(conduction);
  return conduction;
}

namespace {

/// Largest diffusivity along directions in which the melt conducts `factor` times as well [m^2/s].
double fastest(Conduction const& conduction, EnthalpyTable const& table, double factor) {
  double const all = table.max_diffusivity();
  return conduction.liquid.acts() ? std::max(all, factor * table.max_diffusivity(table.liquidus())) : all;
}

}  // namespace

double stable_step(Conduction const& conduction, EnthalpyTable const& table) {
  double const slope = table.max_temperature_slope(), diffusivity = table.max_diffusivity();
  double const lateral = fastest(conduction, table, conduction.liquid.lateral),
               vertical = fastest(conduction, table, conduction.liquid.vertical);
  std::vector<double> rate(static_cast<std::size_t>(conduction.box.size()), 0);
  for (Row const& row : conduction.rows) {
    for (std::int64_t c = row.begin; c < row.end; ++c) {
      if (conduction.fill[c] == 0) continue;
      for (auto const& [axis, step] : directions) {
        rate[c] += (axis == 2 ? vertical : lateral) * shared(conduction, c, c + step * stride(conduction.box, axis));
      }
    }
  }
  for (ContactFace const& face : conduction.contacts) rate[face.cell] += slope * face.conductivity;
  for (FarFace const& face : conduction.far) rate[face.cell] += diffusivity * face.share;
  double largest = 0;
  for (std::size_t c = 0; c < rate.size(); ++c) largest = std::max(largest, rate[c] * conduction.per_capacity[c]);
  return largest > 0 ? 1 / largest : std::numeric_limits<double>::infinity();
}

double conduction_balance(Conduction const& conduction, EnthalpyTable const& table, std::span<double const> enthalpy,
                          std::span<double const> integral, std::span<double> balance) {
  BulkFlow const flow(conduction);
  LiquidConductivity const liquid = conduction.liquid;
  double const* const values = integral.data();
  auto const lateral = [=](std::int64_t c) { return liquid.enhanced(values[c], liquid.lateral, liquid.liquidus); };
  auto const vertical = [=](std::int64_t c) { return liquid.enhanced(values[c], liquid.vertical, liquid.liquidus); };
  double* __restrict const result = balance.data();
  for (Row const& row : conduction.rows) {
#pragma omp simd
    for (std::int64_t c = row.begin; c < row.end; ++c) result[c] = flow(c, lateral, vertical, vertical, vertical);
  }
  for (ContactFace const& face : conduction.contacts) {
    balance[face.cell] +=
        face.conductivity * (table.temperature(enthalpy[face.neighbour]) - table.temperature(enthalpy[face.cell]));
  }
  double far = 0;
  for (FarFace const& face : conduction.far) {
    double const flow = face.share * integral[face.cell];
    balance[face.cell] -= flow;
    far += flow;
  }
  return far * conduction.cell;
}

}  // namespace layerloop::thermal
