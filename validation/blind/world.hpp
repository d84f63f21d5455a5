#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "validation/candidate.hpp"
#include "validation/model.hpp"
#include "validation/study.hpp"
#include "validation/truth/hidden_cause.hpp"

namespace layerloop::validation {

/// What kind of thing is hidden, and with it what a right answer is.
enum class ScenarioClass {
  one_effect,         ///< a: that effect, or its group
  withheld_effect,    ///< c1: an effect that the candidates lack: UNKNOWN
  foreign_cause,      ///< c2: something that no catalogue holds: UNKNOWN with the right pattern
  nothing,            ///< d: no claim
  wrong_calibration,  ///< e: 1 to 5 numbers 2 to 4 prior deviations off: no physics
  two_effects,        ///< f: both
  twins,              ///< g: two candidates that look the same: GROUP
  bad_noise,          ///< h: outliers, understated noise, a systematic error left out: no physics
  not_physics,        ///< i: cells, offsets, scales: named as such
  real_life           ///< r: wrong uncertainties, an unlabelled lot or focus jump, biased inputs: no physics
};

/// Whether a prediction takes microseconds, or is a run of the stages that several scenarios should share.
enum class Effort { free, dear };

/// A model, what may be wrong with it, and a truth to hide in data: what blind scenarios are made of.
class World {
 public:
  virtual ~World() = default;
  virtual std::string name() const = 0;
  virtual Effort effort() const = 0;
  /// Where grains fall by chance, of so many truths the mean is what a visibility is judged by.
  virtual int truths_averaged() const { return 1; }
  virtual std::string case_text() const = 0;               ///< of its studies
  virtual std::vector<ScenarioClass> classes() const = 0;  ///< of the scenarios, one after another, over and over
  virtual Study design(std::uint64_t seed) const = 0;      ///< without values
  virtual std::vector<Candidate> candidates(Study const& study) const = 0;
  virtual std::unique_ptr<Model> model(Study const& study, std::vector<Candidate> const& candidates) const = 0;
  virtual std::vector<std::string> hidden_effects() const = 0;  ///< physics that its data can show
  virtual std::vector<ForeignCause> foreign_causes() const = 0;
  virtual std::vector<ForeignCause> jumps() const = 0;         ///< unlabelled, from some condition on
  virtual std::vector<std::string> biased_inputs() const = 0;  ///< keys
  /// Whether its truth knows the effect in another functional form beside the catalogue's.
  virtual bool has_other_form(std::string const& effect) const = 0;
  /// By observable [SI]. \param seed  of its grains and rays
  virtual Eigen::VectorXd truth(Study const& study, Eigen::VectorXd const& calibration,
                                std::vector<HiddenCause> const& causes, std::uint64_t seed) const = 0;
};

/// The analytic chain, and its truth of other functional forms.
std::unique_ptr<World> analytic_world();

/// The stages of this program. \param name  "powder", "piles", "light", "tracks" or "layer" \param folder  its base
/// case and what was computed stay here \throws InputError  no such name
std::unique_ptr<World> stage_world(std::string const& name, std::filesystem::path const& folder);

/// "analytic", and those of the stages.
std::vector<std::string> world_names();
std::unique_ptr<World> world_of(std::string const& name, std::filesystem::path const& folder);

}  // namespace layerloop::validation
