#pragma once
#include <string>

#include "core/case.hpp"

namespace layerloop {

/// [contact] with the elastic values of a material, or of the walls (walls_name).
ContactSettings contact_of_body(Case const& checked, std::string const& body);

/// contact_of_body() of the first with what [contact.A.B] gives of both; where the second is the walls, `wall_friction`
/// is the friction between them.
ContactSettings contact_of_pair(Case const& checked, std::string const& first, std::string const& second);

}  // namespace layerloop
