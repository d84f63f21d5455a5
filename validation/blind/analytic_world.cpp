#include "validation/blind/analytic_chain.hpp"
#include "validation/blind/analytic_design.hpp"
#include "validation/blind/world.hpp"

namespace layerloop::validation {
namespace {

class AnalyticWorld : public World {
 public:
  std::string name() const override { return "analytic"; }
  Study design(std::uint64_t seed) const override { return analytic_design(seed); }
  std::vector<Candidate> candidates(Study const&) const override { return analytic_candidates(); }
  std::unique_ptr<Model> model(Study const& study, std::vector<Candidate> const& candidates) const override {
    return std::make_unique<AnalyticChain>(study, candidates);
  }
  Eigen::VectorXd truth(Study const& study, Eigen::VectorXd const& calibration,
                        std::vector<HiddenCause> const& causes) const override {
    return true_values(study, calibration, causes);
  }
};

}  // namespace

std::unique_ptr<World> analytic_world() { return std::make_unique<AnalyticWorld>(); }

}  // namespace layerloop::validation
