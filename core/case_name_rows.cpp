// Rows of the tables that have names in their own: [powder.mixture], [contact.A], [contact.A.B] of materials,
// [modifiers.NAME].
#include <algorithm>
#include <array>

#include "core/case_schema.hpp"
#include "core/modifier.hpp"

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

std::vector<CaseKey> modifier_rows(std::string const& name) {
  auto const value = [=](auto ModifierSettings::*member) {
    return [=](Case& into) -> auto& { return into.modifiers[name].*member; };
  };
  using M = ModifierSettings;
  std::string const table = "modifiers." + name;
  Choice const target{
      modifier_targets(),
      [=](Case const& from) {
        auto const& all = modifier_targets();
        return static_cast<std::size_t>(std::ranges::find(all, from.modifiers.at(name).target) - all.begin());
      },
      [=](Case& into, std::size_t index) { into.modifiers[name].target = modifier_targets().at(index); }};
  return {
      {table, "enabled", Member<bool>(value(&M::enabled)), D::none, {}, Need::never, "true",
       "Whether this effect of yours, a formula in the place of a number of the model, is on."},
      {table, "target", target, D::none, {}, Need::always, "",
       "What it changes: `material.conductivity`, `material.specific_heat` or the power that the metal absorbs, `laser.absorbed_power`."},
      {table, "expression", Member<std::string>(value(&M::expression)), D::none, {}, Need::always, "",
       "Formula of the new value [SI], with s the strength. Conductivity: of k, s, T. Specific heat: of c, s, T. Absorbed "
       "power: of absorbed, s, incident [W], t (time that the beam is on), v (scan speed), x, y. For example \"k*(1 + s*(T - 300)/1000)\"."},
      {table, "strength", Member<double>(value(&M::strength)), D::none, {-1e6, 1e6}, Need::never, "1",
       "s in the formula; 0: the effect is left out."},
      {table, "prior_scale", Member<double>(value(&M::prior_scale)), D::none, {0, 1e6, Range::End::open}, Need::never, "0.5",
       "Strength that it may well have, for `explain`."},
      {table, "largest_strength", Member<double>(value(&M::largest_strength)), D::none, {0, 1e6, Range::End::open}, Need::never, "10",
       "Largest strength that `explain` tries."},
  };
}
// clang-format on

bool is_of_names(CaseKey const& row) {
  return row.table == "powder.mixture" || row.table.starts_with("contact.") || row.table.starts_with("modifiers.");
}

std::string family_of(std::string const& table) {
  if (table.starts_with("material.")) return "material";
  if (table.starts_with("modifiers.")) return "modifiers.NAME";
  if (!table.starts_with("contact.") || table == "contact.wall") return table;
  return table.find('.', 8) == std::string::npos ? "contact.NAME" : "contact.NAME.NAME";
}

}  // namespace layerloop
