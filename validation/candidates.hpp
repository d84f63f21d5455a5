#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/case.hpp"
#include "validation/candidate.hpp"
#include "validation/study.hpp"

namespace layerloop::validation {

/// Every cause that could show in a study's quantities: the effects of the catalogue whose stage the study sees, the
/// discretisation, errors of the inputs that power, speed and spot are known by, and offset and scale of each quantity.
/// What the case has on already is a number that may be off, calibration; what it lacks is physics.
std::vector<Candidate> candidates_for(Study const& study, Case const& base);

/// An effect that the study cannot judge.
struct Untestable {
  std::string name;
  std::string why;
};
/// The effects of the catalogue that candidates_for leaves out.
std::vector<Untestable> untestable_effects(Study const& study, Case const& base);

/// What puts a candidate into a case, as --set options: "effects.keyhole.enabled=true". The strength counts from what
/// the case holds already, and brings what the effect needs beside it: an oxide its thickness, cohesion its law. Empty
/// for an instrument, which acts on the reading, and for a strength of 0.
/// \param base  the case under one condition, for factors act on what that sets
std::vector<std::string> settings_of(Candidate const& candidate, double strength, Case const& base);

/// Adds what the instruments among the candidates do to readings. \param values  by observable [SI]
void apply_instruments(Study const& study, std::vector<Candidate> const& candidates, Eigen::VectorXd const& strengths,
                       Eigen::VectorXd& values);

}  // namespace layerloop::validation
