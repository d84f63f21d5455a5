#pragma once
#include <memory>
#include <vector>

#include "validation/candidate.hpp"
#include "validation/model.hpp"
#include "validation/study.hpp"
#include "validation/truth/true_chain.hpp"

namespace layerloop::validation {

/// A model, what may be wrong with it, and a truth to hide in data: what blind scenarios are made of.
class World {
 public:
  virtual ~World() = default;
  virtual std::string name() const = 0;
  virtual Study design(std::uint64_t seed) const = 0;  ///< without values
  virtual std::vector<Candidate> candidates(Study const& study) const = 0;
  virtual std::unique_ptr<Model> model(Study const& study, std::vector<Candidate> const& candidates) const = 0;
  /// By observable [SI].
  virtual Eigen::VectorXd truth(Study const& study, Eigen::VectorXd const& calibration,
                                std::vector<HiddenCause> const& causes) const = 0;
};

/// The analytic chain, and its truth of other functional forms.
std::unique_ptr<World> analytic_world();

}  // namespace layerloop::validation
