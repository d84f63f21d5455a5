// Rows of the tables that have names of materials in their own: [powder.mixture], [contact.A], [contact.A.B].
#include <algorithm>
#include <array>

#include "core/case_schema.hpp"

namespace layerloop {
using D = Dimension;

// One row a key, its sentence last.
// clang-format off
CaseKey mixture_row(std::string const& name) {
  auto const share = [=](Case& into) -> double& { return into.powder.mixture[name]; };
  return {"powder.mixture", name, share, D::none, {0, 1, Range::End::open}, Need::never, "",
          "Share of this material in the mass of the powder, powder.material among them; they sum to 1. All have the same "
          "sizes; which grain is of which is drawn by number, so that these shares come out. Only for spreading."};
}

std::vector<CaseKey> body_rows(std::string const& name) {
  auto const value = [=](std::optional<double> BodySettings::*member) {
    return [=](Case& into) -> std::optional<double>& { return into.bodies[name].*member; };
  };
  using B = BodySettings;
  bool const walls = name == walls_name;
  double const stiffest = walls ? std::numeric_limits<double>::infinity() : 1e12;
  return {
      {"contact." + name, "youngs_modulus", value(&B::youngs_modulus), D::pressure, {1e6, stiffest}, Need::never, "",
       walls ? "Young's modulus of platforms, recoater and plate, if not that of [contact]; \"inf\": rigid."
             : "Young's modulus of this material, if not that of [contact]."},
      {"contact." + name, "poisson_ratio", value(&B::poisson_ratio), D::none, {0, 0.49}, Need::never, "",
       walls ? "Poisson's ratio of the walls, if not that of [contact]."
             : "Poisson's ratio of this material, if not that of [contact]."},
  };
}

std::vector<CaseKey> pair_rows(std::string const& a, std::string const& b) {
  std::array<std::string, 2> const key{std::min(a, b), std::max(a, b)};
  auto const value = [=](std::optional<double> PairSettings::*member) {
    return [=](Case& into) -> std::optional<double>& { return into.pairs[key].*member; };
  };
  using P = PairSettings;
  std::string const table = "contact." + a + "." + b;
  return {
      {table, "restitution", value(&P::restitution), D::none, {0.01, 1}, Need::never, "",
       "Restitution between these two materials (order does not matter; one may be `wall`), if not that of [contact]."},
      {table, "sliding_friction", value(&P::sliding_friction), D::none, {0, 5}, Need::never, "",
       "Coulomb friction between them, if not that of [contact]; with `wall`: its wall_friction."},
      {table, "rolling_friction", value(&P::rolling_friction), D::none, {0, 5}, Need::never, "",
       "Rolling friction between them, if not that of [contact]."},
      {table, "cohesion_energy_density", value(&P::cohesion_energy_density), D::energy_density, {0, 1e9}, Need::never, "",
       "Cohesion energy density between them, if not that of [contact]."},
      {table, "surface_energy", value(&P::surface_energy), D::surface_energy, {0, 10}, Need::never, "",
       "Half of the work of adhesion between them, if not that of [contact]."},
  };
}
// clang-format on

bool is_of_names(CaseKey const& row) { return row.table == "powder.mixture" || row.table.starts_with("contact."); }

std::string family_of(std::string const& table) {
  if (table.starts_with("material.")) return "material";
  if (!table.starts_with("contact.") || table == "contact.wall") return table;
  return table.find('.', 8) == std::string::npos ? "contact.NAME" : "contact.NAME.NAME";
}

}  // namespace layerloop
