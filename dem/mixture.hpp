#pragma once
#include <string>
#include <vector>

#include "dem/contact_law.hpp"

namespace layerloop::dem {

/// What the motion has to know of a powder of several materials, by PowderBed::material. Empty: all grains are alike.
struct Mixture {
  std::vector<double> density;             ///< [kg/m^3]
  std::vector<ContactSettings> contact;    ///< between grains of one material
  std::vector<ContactLaw> between_grains;  ///< of materials a and b at [a * materials + b]; symmetric
  std::vector<ContactLaw> at_walls;

  std::size_t materials() const { return density.size(); }
};

/// That of the case; empty with one material.
Mixture mixture_of(Case const& checked);

/// Contact values of two materials, or of a material and the walls (walls_name), with the case's effects; elastic
/// values are those of the first.
ContactSettings contact_between(Case const& checked, std::string const& first, std::string const& second);

/// Laws of two materials, and of a material and the walls.
ContactLaw grain_law(Case const& checked, std::string const& first, std::string const& second);
ContactLaw wall_law(Case const& checked, std::string const& material);

/// PowderBed::material of the grain with this id: a pure function of seed and id. Shares by number are shares of the
/// mass over density, since all materials have the same sizes.
std::int32_t draw_material(Case const& checked, std::int64_t id);

}  // namespace layerloop::dem
