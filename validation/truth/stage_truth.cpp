#include "validation/truth/stage_truth.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/grain_size.hpp"
#include "core/write_file.hpp"
#include "dem/contact_law.hpp"
#include "validation/stage_model.hpp"
#include "validation/study_setup.hpp"

namespace layerloop::validation {
namespace {

/// The disturbed world: a study whose conditions hold what the case does not say.
struct Disturbed {
  Study study;
  std::string formulas = {};  ///< [modifiers.*] of its case
  Eigen::VectorXd strengths;  ///< by candidate

  void set_all(std::string const& key, double value) {
    for (Condition& condition : study.conditions) condition.inputs[key] = value;
  }
  void say_all(std::string const& key, std::string const& word) {
    for (Condition& condition : study.conditions) condition.words[key] = word;
  }
  void add_strength(std::vector<Candidate> const& candidates, std::string const& name, double strength) {
    for (std::size_t c = 0; c < candidates.size(); ++c)
      if (candidates[c].name == name) strengths[index(c)] += strength;
  }
};

/// Surface energy whose pull-off force is `bond` times the weight of the grain of mean volume [J/m^2].
double surface_energy_of(double bond, Study const& study) {
  Case const base = first_case(study);
  ContactSettings contact = base.contact;
  contact.cohesion = Cohesion::dmt;
  contact.surface_energy = 1;
  double const radius = 0.5 * std::cbrt(mean_grain_volume(base.powder) * 6 / std::numbers::pi);
  return bond / dem::bond_number(radius, base.material.density, contact);  // linear in the energy
}

using Form = std::function<void(Disturbed&, double strength)>;

/// Effects in a form of their own; those that return leave the catalogue's strength alone.
std::map<std::string, Form> const& forms_instead() {
  static std::map<std::string, Form> const forms{
      {"cohesion",
       [](Disturbed& world, double s) {
         double const energy = surface_energy_of(10 * s, world.study);  // the catalogue's strength 1: bond number 10
         world.say_all("contact.cohesion", "dmt");
         world.set_all("contact.surface_energy", energy);
       }},
      {"rolling_resistance",
       [](Disturbed& world, double s) {
         world.say_all("contact.rolling_model", "epsd2");
         world.set_all("contact.rolling_friction", 0.2 * s);
       }},
      {"latent_heat",
       [](Disturbed& world, double s) {
         world.formulas += fmt::format(
             "[modifiers.mushy]\ntarget = \"material.specific_heat\"\nexpression = "
             "\"c + s*264e3*exp(-((T - 1650)/200)^2)/(200*1.7725)\"\nstrength = {}\n",
             s);
       }},
      {"variable_conductivity", [](Disturbed& world, double s) {
         world.formulas += fmt::format(
             "[modifiers.linear]\ntarget = \"material.conductivity\"\nexpression = "
             "\"k*(1 + s*0.00036*(T - 1675))\"\nstrength = {}\n",
             s);
       }}};
  return forms;
}

/// Effects of the catalogue with other parameters.
std::map<std::string, Form> const& forms_beside() {
  static std::map<std::string, Form> const forms{
      {"blade_vibration", [](Disturbed& world, double) { world.set_all("effects.blade_vibration.frequency", 900); }},
      {"surface_oxide", [](Disturbed& world, double) { world.say_all("optics.oxide_index", "[2.4, 0.15]"); }},
      {"marangoni", [](Disturbed& world, double) {
         world.set_all("effects.marangoni.lateral_factor", 2.6);
         world.set_all("effects.marangoni.vertical_factor", 1.3);
       }}};
  return forms;
}

void scale(Condition& condition, std::string const& key, double factor) {
  if (auto const input = condition.inputs.find(key); input != condition.inputs.end()) input->second *= factor;
}

/// Grains of another lot roll worse and carry an oxide.
void change_lot(Condition& condition, double strength) {
  condition.inputs["contact.rolling_friction"] = 0.2 * std::abs(strength);
  condition.inputs["optics.oxide_thickness"] = 1e-8 * std::abs(strength);
}

/// What is in no catalogue, condition by condition in the order of acquisition.
void disturb_conditions(Disturbed& world, HiddenCause const& cause) {
  static std::string const error = "error of ";
  auto const count = static_cast<double>(world.study.conditions.size());
  for (std::size_t c = 0; c < world.study.conditions.size(); ++c) {
    Condition& condition = world.study.conditions[c];
    double const order = static_cast<double>(c) / count, s = cause.strength;
    auto const is = [&](char const* label, char const* value) { return condition.labels.at(label) == value; };
    if (cause.name.starts_with(error) && (cause.label.empty() || is("machine", cause.label.c_str())))
      scale(condition, cause.name.substr(error.size()), 1 + s);
    if (cause.name == "lot_jump" && order >= cause.from) change_lot(condition, s);
    if (cause.name == "focus_jump" && order >= cause.from) scale(condition, "laser.spot_diameter", 1 + 0.12 * s);
    if (cause.name == "lot_change" && is("lot", "L2")) change_lot(condition, s);
    if (cause.name == "power_drift") scale(condition, "laser.power", 1 - 0.1 * s * order);
    if (cause.name == "dirty_window" && is("machine", "B")) scale(condition, "laser.power", 1 - 0.1 * s);
  }
}

Disturbed disturbed(Study const& study, std::vector<Candidate> const& candidates,
                    std::vector<HiddenCause> const& causes) {
  Disturbed world{.study = study, .strengths = Eigen::VectorXd::Zero(index(candidates.size()))};
  for (HiddenCause const& cause : causes) {
    disturb_conditions(world, cause);
    if (cause.other_form && forms_instead().contains(cause.name)) {
      forms_instead().at(cause.name)(world, cause.strength);
      continue;
    }
    if (cause.other_form) forms_beside().at(cause.name)(world, cause.strength);
    world.add_strength(candidates, cause.name, cause.strength);
  }
  return world;
}

/// A case file that goes away: what is hidden must not stay beside the studies.
class HiddenCase {
 public:
  HiddenCase(Study const& study, std::string const& formulas)
      : file_(std::filesystem::temp_directory_path() / fmt::format("layerloop_truth_{}.toml", ::getpid())) {
    write_file(file_, read_file(study.case_file) + formulas);
  }
  ~HiddenCase() { std::filesystem::remove(file_); }
  HiddenCase(HiddenCase const&) = delete;
  HiddenCase& operator=(HiddenCase const&) = delete;
  std::filesystem::path const& file() const { return file_; }

 private:
  std::filesystem::path file_;
};

}  // namespace

bool has_other_stage_form(std::string const& effect) {
  return forms_instead().contains(effect) || forms_beside().contains(effect);
}

Eigen::VectorXd stage_truth(StageTruth const& how, Study study, std::vector<Candidate> const& candidates,
                            Eigen::VectorXd const& calibration, std::vector<HiddenCause> const& causes,
                            std::uint64_t seed) {
  Disturbed world = disturbed(study, candidates, causes);
  for (auto const& [key, value] : how.resolution) world.set_all(key, value);
  HiddenCase const hidden(study, world.formulas);
  world.study.case_file = hidden.file();
  Communicator const comm;
  auto const stages = stage_model(world.study, candidates, {.cache = how.cache, .beds = how.beds, .quiet = true}, comm);
  return stages->predict({calibration, world.strengths, seed}).value;
}

}  // namespace layerloop::validation
