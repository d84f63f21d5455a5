#include "validation/next_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "validation/gaussian_process.hpp"
#include "validation/proposal.hpp"
#include "validation/quantity.hpp"
#include "validation/rival_fits.hpp"

namespace layerloop::validation {
namespace {

constexpr std::size_t varied_keys = 3, simulated_proposals = 3, fewest_for_surrogate = 6, most_places = 3;

std::vector<std::string> varied_inputs(Study const& study) {
  std::map<std::string, std::set<double>> levels;
  for (Condition const& c : study.conditions)
    for (auto const& [key, value] : c.inputs) levels[key].insert(value);
  std::vector<std::string> keys;
  for (auto const& [key, values] : levels)
    if (values.size() > 1) keys.push_back(key);
  std::ranges::stable_sort(keys, {}, [&](std::string const& key) { return -static_cast<int>(levels[key].size()); });
  if (keys.size() > varied_keys) keys.resize(varied_keys);
  return keys;
}

/// What the runs of the study give, measured or not.
std::vector<std::string> quantities_of_runs(Study const& study) {
  std::set<std::string> names;
  bool melted = false;
  for (Observation const& seen : study.observations) {
    names.insert(seen.quantity);
    melted = melted || seen.quantity.starts_with("pool.");
  }
  if (melted) names.insert({"pool.width", "pool.depth", "absorptivity"});
  return {names.begin(), names.end()};
}

/// Functions of the conditions, known at those of the study.
class Surrogates {
 public:
  Surrogates(Eigen::MatrixXd const& places, RivalPredictions const& known) {
    for (std::size_t r = 0; r < known.value.size(); ++r) {
      value_.push_back(process(places, known.value[r]));
      auto& slopes = slopes_.emplace_back();
      for (Eigen::Index k = 0; k < known.derivative[r].cols(); ++k)
        slopes.push_back(process(places, known.derivative[r].col(k)));
    }
  }
  double value(std::size_t rival, Eigen::RowVectorXd const& place) const { return at(value_[rival], place); }
  Eigen::RowVectorXd derivative(std::size_t rival, Eigen::RowVectorXd const& place) const {
    Eigen::RowVectorXd all(index(slopes_[rival].size()));
    for (Eigen::Index k = 0; k < all.size(); ++k) all[k] = at(slopes_[rival][static_cast<std::size_t>(k)], place);
    return all;
  }

 private:
  static std::optional<GaussianProcess> process(Eigen::MatrixXd const& places, Eigen::VectorXd const& values) {
    std::vector<Eigen::Index> known;
    for (Eigen::Index i = 0; i < values.size(); ++i)
      if (std::isfinite(values[i])) known.push_back(i);
    if (known.size() < 2) return std::nullopt;
    Eigen::VectorXd const v = values(known);
    double const spread = std::max((v.array() - v.mean()).abs().maxCoeff(), 1e-9 * v.cwiseAbs().maxCoeff() + 1e-30);
    Eigen::VectorXd const noise = Eigen::VectorXd::Constant(v.size(), 1e-6 * spread * spread);
    return fit_gaussian_process(places(known, Eigen::all), v, noise);
  }
  static double at(std::optional<GaussianProcess> const& process, Eigen::RowVectorXd const& place) {
    return process ? (*process)(place).mean : std::nan("");
  }
  std::vector<std::optional<GaussianProcess>> value_;
  std::vector<std::vector<std::optional<GaussianProcess>>> slopes_;
};

Eigen::RowVectorXd place_of(Condition const& condition, std::vector<std::string> const& keys, Study const& study) {
  Eigen::RowVectorXd place(index(keys.size()));
  for (std::size_t k = 0; k < keys.size(); ++k) {
    double low = 1e300, high = -1e300;
    for (Condition const& c : study.conditions)
      if (auto const found = c.inputs.find(keys[k]); found != c.inputs.end())
        low = std::min(low, found->second), high = std::max(high, found->second);
    auto const own = condition.inputs.find(keys[k]);
    place[index(k)] = own == condition.inputs.end() || high <= low ? 0 : (own->second - low) / (high - low);
  }
  return place;
}

bool is_corner(Eigen::RowVectorXd const& place) { return (place.array().min(1 - place.array()).abs() < 1e-9).all(); }

Study under(Study const& study, std::vector<Condition> const& conditions, std::vector<std::size_t> const& origin) {
  Study other = study;
  other.conditions = conditions;
  for (CalibrationParameter& number : other.calibration) {
    if (number.acts_on.empty()) continue;
    std::vector<bool> acts;
    for (std::size_t const c : origin) acts.push_back(number.acts_on[c]);
    number.acts_on = acts;
  }
  return other;
}

class Search {
 public:
  Search(Explanation const& explained, Model& model, ModelOf const& model_of)
      : explained_(explained), study_(explained.study), model_of_(model_of) {
    ResidualFrame const frame(study_, model.predict(explained.found.final_point));
    rivals_ = fit_rivals(explained, model, frame);
    sigma_ = std::sqrt(explained.found.sigma2);
    for (Fit const& fit : rivals_.fits) {
      now_.difference.push_back(frame.change(rivals_.fits[0].prediction, fit.prediction) / sigma_);
      now_.derivatives.push_back(fit.jacobian / sigma_);
    }
  }

  std::vector<NextExperiment> proposals() {
    if (rivals_.fits.size() < 2) return {};
    screen();
    simulate();
    if (std::ranges::none_of(found_, [](NextExperiment const& next) { return next.replicates <= most_replicates; }))
      combine();
    std::erase_if(found_, [](NextExperiment const& next) { return next.replicates > most_replicates; });
    std::ranges::stable_sort(found_, better);
    return found_;
  }

 private:
  void screen() {
    std::vector<std::string> const keys = varied_inputs(study_);
    conditions_ = condition_grid(study_, origin_);
    Eigen::MatrixXd places(index(study_.conditions.size()), index(keys.size()));
    for (std::size_t c = 0; c < study_.conditions.size(); ++c)
      places.row(index(c)) = place_of(study_.conditions[c], keys, study_);
    std::map<std::string, RivalPredictions> const known = known_predictions();
    bool const between = study_.conditions.size() >= fewest_for_surrogate;
    std::map<std::string, Surrogates> surrogates;
    for (auto const& [quantity, predicted] : known) {
      quantities_.push_back(quantity);
      if (std::ranges::find(study_.observations, quantity, &Observation::quantity) != study_.observations.end())
        read_.push_back(quantity);
      if (between) surrogates.emplace(quantity, Surrogates(places, predicted));
    }
    for (std::size_t c = 0; c < conditions_.size(); ++c) {
      Eigen::RowVectorXd const place = place_of(conditions_[c], keys, study_);
      bool const measured = c < study_.conditions.size();
      if (!measured && is_corner(place)) corners_.push_back(c);
      if (!measured && !between) continue;
      auto const proposals = proposals_at(c, [&](std::string const& quantity, std::size_t r) {
        return measured
                   ? Predicted{known.at(quantity).value[r][index(c)], known.at(quantity).derivative[r].row(index(c))}
                   : Predicted{surrogates.at(quantity).value(r, place), surrogates.at(quantity).derivative(r, place)};
      });
      for (Proposal const& p : proposals) screened_.push_back(judge(p));
    }
    std::ranges::stable_sort(screened_, better);
  }

  std::map<std::string, RivalPredictions> known_predictions() const {
    auto const predict = [&](std::vector<std::string> const& quantities) {
      return predict_rivals(study_, quantities, explained_.candidates, rivals_, model_of_, true);
    };
    try {
      return predict(quantities_of_runs(study_));
    } catch (InputError const&) {  // a model that gives no more than it was asked for
      std::set<std::string> names;
      for (Observation const& seen : study_.observations) names.insert(seen.quantity);
      return predict({names.begin(), names.end()});
    }
  }

  /// What a rival says of one quantity under one condition.
  struct Predicted {
    double value = 0;
    Eigen::RowVectorXd derivative;
  };

  NextExperiment judge(Proposal const& p) const { return judged(p, conditions_, now_, study_, sigma_, rivals_.names); }

  /// Under one condition: every quantity alone, and last all that the study reads together.
  template <class Predict>
  std::vector<Proposal> proposals_at(std::size_t condition, Predict const& predict) const {
    std::vector<Proposal> proposals;
    std::vector<std::vector<std::string>> choices;
    for (std::string const& quantity : quantities_)
      if (read_ != std::vector{quantity}) choices.push_back({quantity});
    choices.push_back(read_);
    for (std::vector<std::string> const& chosen : choices) {
      Proposal p{
          .conditions = std::vector(chosen.size(), condition), .quantities = chosen, .value = {}, .derivative = {}};
      for (std::size_t r = 0; r < rivals_.fits.size(); ++r) {
        p.value.emplace_back(index(chosen.size()));
        p.derivative.emplace_back(index(chosen.size()), rivals_.fits[r].jacobian.cols());
        for (std::size_t q = 0; q < chosen.size(); ++q) {
          Predicted const one = predict(chosen[q], r);
          p.value[r][index(q)] = one.value;
          p.derivative[r].row(index(q)) = one.derivative;
        }
      }
      if (p.is_known()) proposals.push_back(std::move(p));
    }
    return proposals;
  }

  /// True runs at the best few places, and at the corners of the range, where a surrogate has to extrapolate.
  void simulate() {
    std::vector<std::size_t> chosen;
    for (NextExperiment const& next : screened_) {
      auto const c = static_cast<std::size_t>(std::ranges::find(conditions_, next.condition.id, &Condition::id) -
                                              conditions_.begin());
      if (std::ranges::find(chosen, c) == chosen.end() && chosen.size() < simulated_proposals) chosen.push_back(c);
    }
    for (std::size_t const corner : corners_)
      if (std::ranges::find(chosen, corner) == chosen.end()) chosen.push_back(corner);
    if (chosen.empty()) return;
    std::vector<Condition> conditions;
    std::vector<std::size_t> origin;
    for (std::size_t const c : chosen) conditions.push_back(conditions_[c]), origin.push_back(origin_[c]);
    auto const truth =
        predict_rivals(under(study_, conditions, origin), quantities_, explained_.candidates, rivals_, model_of_, true);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      auto const proposals = proposals_at(chosen[i], [&](std::string const& quantity, std::size_t r) {
        RivalPredictions const& of = truth.at(quantity);
        return Predicted{of.value[r][index(i)], of.derivative[r].row(index(i))};
      });
      for (Proposal const& p : proposals) keep_simulated(judge(p));
      if (!proposals.empty() && proposals.back().quantities == read_) simulated_.push_back(proposals.back());
    }
  }

  void keep_simulated(NextExperiment next) {
    next.simulated = true;
    found_.push_back(std::move(next));
  }

  /// Where no single place tells the rivals apart: the best with the one beside it that helps most, and so on.
  void combine() {
    auto const is_better = [&](Proposal const& a, Proposal const& b) { return better(judge(a), judge(b)); };
    if (simulated_.empty()) return;
    Proposal best = *std::ranges::min_element(simulated_, is_better);
    for (std::size_t places = 2; places <= most_places && places <= simulated_.size(); ++places) {
      std::vector<Proposal> wider;
      for (Proposal const& p : simulated_)
        if (std::ranges::find(best.conditions, p.conditions.front()) == best.conditions.end())
          wider.push_back(joined(best, p));
      best = *std::ranges::min_element(wider, is_better);
      keep_simulated(judge(best));
      if (found_.back().replicates <= most_replicates) return;
    }
  }

  Explanation const& explained_;
  Study const& study_;
  ModelOf const& model_of_;
  RivalFits rivals_;
  Standing now_;
  double sigma_ = 1;
  std::vector<Condition> conditions_;
  std::vector<std::size_t> origin_, corners_;
  std::vector<std::string> quantities_, read_;  ///< of the runs; and those of them that the study reads
  std::vector<NextExperiment> screened_, found_;
  std::vector<Proposal> simulated_;  ///< all that the study reads, at every place where true runs were made
};

/// Again, and in random order: the two conditions where the quantity that is worst off is most off either way.
std::vector<NextExperiment> extremes(Explanation const& explained) {
  Study const& study = explained.study;
  std::map<std::string, std::map<std::size_t, std::pair<double, int>>> means;
  std::map<std::string, double> squares;
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    Observation const& seen = study.observations[i];
    double const r = explained.found.table.residual_after[index(i)];
    auto& [sum, n] = means[seen.quantity][seen.condition];
    sum += r, ++n;
    squares[seen.quantity] += r * r;
  }
  if (squares.empty()) return {};
  std::string const worst = std::ranges::max_element(squares, {}, [](auto const& s) { return s.second; })->first;
  auto const mean = [](auto const& entry) { return entry.second.first / entry.second.second; };
  auto const low = std::ranges::min_element(means[worst], {}, mean),
             high = std::ranges::max_element(means[worst], {}, mean);
  auto const& left = explained.found.patterns_after;
  std::string const pattern = left.empty() ? "what is left over" : left.front().text;
  std::vector<NextExperiment> all;
  for (auto const& at : {high, low}) {
    if (!all.empty() && high == low) break;
    double const u = std::abs(mean(*at)) > 0 ? reading_error(study, worst).random : 0;
    all.push_back({.condition = study.conditions[at->first],
                   .quantity = worst,
                   .replicates = 3,
                   .separation = mean(*at) * mean(*at),
                   .difference = 0,
                   .u = u,
                   .separates = {pattern, "chance"}});
    for (Observation const& seen : study.observations)
      if (seen.condition == at->first && seen.quantity == worst) all.back().u = seen.u_stat;
    all.back().difference = mean(*at) * all.back().u;
  }
  return all;
}

}  // namespace

std::vector<Condition> condition_grid(Study const& study, std::vector<std::size_t>& origin) {
  std::vector<Condition> all = study.conditions;
  origin.clear();
  for (std::size_t c = 0; c < all.size(); ++c) origin.push_back(c);
  std::vector<std::string> const keys = varied_inputs(study);
  if (keys.empty()) return all;
  std::size_t const levels = keys.size() == 1 ? 9 : 5;
  std::size_t count = 1;
  for (std::size_t k = 0; k < keys.size(); ++k) count *= levels;
  Eigen::MatrixXd places(index(study.conditions.size()), index(keys.size()));
  for (std::size_t c = 0; c < study.conditions.size(); ++c)
    places.row(index(c)) = place_of(study.conditions[c], keys, study);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::RowVectorXd place(index(keys.size()));
    for (std::size_t k = 0, rest = i; k < keys.size(); ++k, rest /= levels)
      place[index(k)] = static_cast<double>(rest % levels) / static_cast<double>(levels - 1);
    Eigen::Index nearest;
    double const distance = (places.rowwise() - place).rowwise().norm().minCoeff(&nearest);
    if (distance < 0.02) continue;  // measured already
    Condition next = study.conditions[static_cast<std::size_t>(nearest)];
    next.id = "new " + std::to_string(all.size() + 1);
    bool complete = true;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      double low = 1e300, high = -1e300;
      for (Condition const& c : study.conditions)
        if (auto const found = c.inputs.find(keys[k]); found != c.inputs.end())
          low = std::min(low, found->second), high = std::max(high, found->second);
      complete = complete && next.inputs.contains(keys[k]);
      next.inputs[keys[k]] = std::lerp(low, high, place[index(k)]);
    }
    if (!complete) continue;  // the nearest condition has no such input
    all.push_back(next);
    origin.push_back(static_cast<std::size_t>(nearest));
  }
  return all;
}

std::vector<NextExperiment> next_experiments(Explanation const& explained, Model& model, ModelOf const& model_of) {
  switch (explained.found.verdict) {
    case Verdict::GROUP:
      return Search(explained, model, model_of).proposals();
    case Verdict::UNKNOWN:
    case Verdict::PARTIAL:
    case Verdict::CONFOUNDED:
      return extremes(explained);
    default:
      return {};
  }
}

}  // namespace layerloop::validation
