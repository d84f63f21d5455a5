#include "validation/blind/analytic_chain.hpp"
#include "validation/blind/analytic_design.hpp"
#include "validation/blind/world.hpp"
#include "validation/truth/true_chain.hpp"

namespace layerloop::validation {
namespace {

/// The chain is not the program: this only makes the folder a study.
constexpr auto text = R"([powder]
material = "316L"

[laser]
power = "200 W"
wavelength = "1070 nm"
spot_diameter = "80 um"
spot_definition = "D4sigma"
absorptivity = 0.35

[scan]
kind = "track"
scan_speed = "800 mm/s"
track_length = "1 mm"
)";

/// Of a hundred 20 a, 7 c1, 7 c2, 10 d, 8 e, 6 f, 4 g, 5 i, and a third with what real data carry, 9 h and 24 r.
std::vector<ScenarioClass> shares_of_hundred() {
  using enum ScenarioClass;
  std::vector<ScenarioClass> shares;
  for (auto const& [kind, count] : {std::pair{one_effect, 20},
                                    {withheld_effect, 7},
                                    {foreign_cause, 7},
                                    {nothing, 10},
                                    {wrong_calibration, 8},
                                    {two_effects, 6},
                                    {twins, 4},
                                    {not_physics, 5},
                                    {bad_noise, 9},
                                    {real_life, 24}})
    shares.insert(shares.end(), static_cast<std::size_t>(count), kind);
  std::vector<ScenarioClass> spread;  // so that the start of a set has them all
  for (std::size_t i = 0; i < shares.size(); ++i) spread.push_back(shares[i * 37 % shares.size()]);
  return spread;
}

class AnalyticWorld : public World {
 public:
  std::string name() const override { return "analytic"; }
  Effort effort() const override { return Effort::free; }
  std::string case_text() const override { return text; }
  std::vector<ScenarioClass> classes() const override { return shares_of_hundred(); }
  Study design(std::uint64_t seed) const override { return analytic_design(seed); }
  std::vector<Candidate> candidates(Study const&) const override { return analytic_candidates(); }
  std::unique_ptr<Model> model(Study const& study, std::vector<Candidate> const& candidates) const override {
    return std::make_unique<AnalyticChain>(study, candidates);
  }
  std::vector<std::string> hidden_effects() const override {
    std::vector<std::string> names;
    for (Candidate const& candidate : analytic_candidates())
      if (candidate.kind == EffectClass::physics) names.push_back(candidate.name);
    return names;
  }
  std::vector<ForeignCause> foreign_causes() const override { return validation::foreign_causes(); }
  std::vector<ForeignCause> jumps() const override { return {{"focus_jump", 2, {}, {}}, {"lot_jump", 3, {}, {}}}; }
  std::vector<std::string> biased_inputs() const override {
    return {"laser.power", "scan.scan_speed", "laser.spot_diameter"};
  }
  bool has_other_form(std::string const&) const override { return false; }  // it has no other
  Eigen::VectorXd truth(Study const& study, Eigen::VectorXd const& calibration, std::vector<HiddenCause> const& causes,
                        std::uint64_t) const override {
    return true_values(study, calibration, causes);
  }
};

}  // namespace

std::unique_ptr<World> analytic_world() { return std::make_unique<AnalyticWorld>(); }

}  // namespace layerloop::validation
