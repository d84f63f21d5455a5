#pragma once
#include <string>
#include <vector>

#include "core/case.hpp"
#include "core/expression.hpp"
#include "core/user_effect.hpp"

namespace layerloop {

// [modifiers.NAME]: an effect of the user's, written in the case file. It replaces what its target gives by the value
// of a formula, in which s is its strength; at strength 0 it is left out.

/// Names of the variables in a target's formula; the first is what the target gives without it. Empty: no such target.
std::vector<std::string> const& variables_of(std::string const& target);
std::vector<std::string> const& modifier_targets();

/// Stage that a target belongs to.
EffectStage stage_of_target(std::string const& target);

/// The case's material with what its modifiers, in the order of their names, and then effects of loaded libraries make
/// of conductivity and specific heat: tables in steps of 25 K from 250 to 5000 K and at their own points. To the bit
/// the material of the case where none is on. \throws InputError  a property would not be positive
Material modified_material(Case const& checked);

/// The same for the power that a beam leaves in the metal.
class ModifiedAbsorption {
 public:
  explicit ModifiedAbsorption(Case const& checked);
  bool acts() const { return !formulas_.empty() || !effects_.empty(); }
  /// \return absorbed power [W] \throws InputError  it would not lie between 0 and beam.incident
  double operator()(BeamMoment beam) const;

 private:
  struct Formula {
    std::string name;
    double strength;
    Expression expression;
  };
  std::vector<Formula> formulas_;
  std::vector<ActiveUserEffect> effects_;
};

}  // namespace layerloop
