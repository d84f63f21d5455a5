#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "validation/blind/world.hpp"
#include "validation/diagnosis.hpp"

namespace layerloop::validation {

/// What an analysis commits itself to before the answer is opened.
struct Judgement {
  struct Named {
    std::string name;
    bool is_physics = true;
    double strength = 0, u_strength = 0;
    std::vector<std::string> group = {};  ///< what the data cannot tell from it
  };
  std::string verdict;
  std::vector<Named> named;           ///< the first is the best
  std::vector<std::string> patterns;  ///< of what is left, strongest first
  double sigma2 = 1, passes = 0;
  /// Where the model is to predict what was held out: calibrated, and with what was found.
  std::vector<double> calibrated, final_calibration, final_strengths;

  bool names_physics() const;
  bool contains(std::string const& name) const;  ///< among the named or their groups
  std::size_t set_size() const;                  ///< of the first and its group
};

void to_json(nlohmann::json& json, Judgement const& judgement);
void from_json(nlohmann::json const& json, Judgement& judgement);

/// Candidates of a world without those that the analysis must not know.
std::vector<Candidate> known_candidates(World const& world, Study const& study,
                                        std::vector<std::string> const& withheld);

/// The diagnosis of this program. \pre `training` holds training rows alone
Judgement judge(World const& world, Study const& training, std::vector<std::string> const& withheld,
                Thresholds const& thresholds, std::uint64_t seed);

/// What others do with the same residuals, after an ordinary calibration; none of them projects it out.
enum class Baseline {
  largest_correlation,  ///< the signature most correlated with the residual, at 1 % over the family
  stepwise_bic,         ///< forward selection while the Bayesian information criterion falls
  lasso                 ///< l1-penalised fit, its penalty chosen by the same criterion
};
constexpr int baselines = 3;
std::string const& name_of(Baseline baseline);
std::vector<Judgement> judge_by_baselines(World const& world, Study const& training,
                                          std::vector<std::string> const& withheld);

}  // namespace layerloop::validation
