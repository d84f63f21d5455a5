#include "validation/next_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "validation/gaussian_process.hpp"
#include "validation/quantity.hpp"
#include "validation/rival_fits.hpp"

namespace layerloop::validation {
namespace {

constexpr double told_apart = 10.8;  // squared distance at which 95 of 100 studies choose right by 6 of -2 ln L
constexpr int most_replicates = 20;
constexpr std::size_t varied_keys = 3, simulated_proposals = 3, fewest_for_surrogate = 6;
constexpr double common_uncertainty = 0.05;  // relative, of a quantity that the study has no reading of

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

/// One reading of a quantity: what about it averages out over replicates, and what does not; relative.
struct ReadingError {
  double random = common_uncertainty, shared = 0;
};
ReadingError reading_error(Study const& study, std::string const& quantity) {
  std::vector<double> random, shared;
  for (Observation const& seen : study.observations) {
    if (seen.quantity != quantity || seen.value == 0) continue;
    random.push_back(seen.u_stat / std::abs(seen.value));
    shared.push_back(std::hypot(seen.u_sys_rel, seen.u_sys_abs / seen.value));
  }
  if (random.empty()) return {};
  std::ranges::sort(random);
  std::ranges::sort(shared);
  return {random[random.size() / 2], shared[shared.size() / 2]};
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

/// The data as they are, for every pair of the best explanation with a rival.
struct Standing {
  std::vector<Eigen::VectorXd> difference;   ///< by rival, the first is the best one: unused
  std::vector<Eigen::MatrixXd> derivatives;  ///< by rival
};

struct Proposal {
  std::size_t condition = 0, origin = 0;
  std::string quantity;
  std::vector<double> value;                   ///< by rival
  std::vector<Eigen::RowVectorXd> derivative;  ///< by rival
};

/// Least separation of the best explanation from any rival with so many readings more.
double separation_with(Proposal const& p, Standing const& now, ReadingError const& error, double sigma, int readings) {
  double const u = sigma * std::abs(p.value[0]) * std::hypot(error.random / std::sqrt(readings), error.shared);
  double least = 1e300;
  for (std::size_t r = 1; r < p.value.size(); ++r) {
    double const d = (p.value[0] - p.value[r]) / u;
    least = std::min({least, separation(now.difference[r], now.derivatives[r], d, p.derivative[r] / u),
                      separation(now.difference[r], now.derivatives[0], d, p.derivative[0] / u)});
  }
  return least;
}

NextExperiment judged(Proposal const& p, Condition const& condition, Standing const& now, ReadingError const& error,
                      double sigma, std::vector<std::string> const& names) {
  NextExperiment next{.condition = condition, .quantity = p.quantity, .separates = names};
  next.separation = separation_with(p, now, error, sigma, 1);
  next.u = sigma * std::abs(p.value[0]) * std::hypot(error.random, error.shared);
  for (std::size_t r = 1; r < p.value.size(); ++r)
    if (r == 1 || std::abs(p.value[0] - p.value[r]) < std::abs(next.difference))
      next.difference = p.value[0] - p.value[r];
  next.replicates = most_replicates + 1;
  for (int n = most_replicates; n >= 1; --n)
    if (separation_with(p, now, error, sigma, n) >= told_apart) next.replicates = n;
  return next;
}

bool better(NextExperiment const& a, NextExperiment const& b) {
  return std::pair(a.replicates, -a.separation) < std::pair(b.replicates, -b.separation);
}

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
    std::erase_if(found_, [](NextExperiment const& next) { return next.replicates > most_replicates; });
    std::ranges::stable_sort(found_, better);
    return found_;
  }

 private:
  void screen() {
    std::vector<std::string> const keys = varied_inputs(study_);
    conditions_ = condition_grid(study_, origin_);
    if (study_.conditions.size() < fewest_for_surrogate) conditions_.resize(study_.conditions.size());
    Eigen::MatrixXd places(index(study_.conditions.size()), index(keys.size()));
    for (std::size_t c = 0; c < study_.conditions.size(); ++c)
      places.row(index(c)) = place_of(study_.conditions[c], keys, study_);
    for (auto const& [quantity, known] : known_predictions()) {
      Surrogates const surrogates(places, known);
      for (std::size_t c = 0; c < conditions_.size(); ++c) {
        Proposal p{.condition = c, .origin = origin_[c], .quantity = quantity, .value = {}, .derivative = {}};
        Eigen::RowVectorXd const place = place_of(conditions_[c], keys, study_);
        bool const measured = c < study_.conditions.size();
        for (std::size_t r = 0; r < rivals_.fits.size(); ++r) {
          p.value.push_back(measured ? known.value[r][index(c)] : surrogates.value(r, place));
          p.derivative.push_back(measured ? Eigen::RowVectorXd(known.derivative[r].row(index(c)))
                                          : surrogates.derivative(r, place));
        }
        keep(std::move(p));
      }
    }
    std::ranges::stable_sort(screened_, better, &std::pair<NextExperiment, Proposal>::first);
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

  void keep(Proposal p) {
    double sum = 0;
    for (double const value : p.value) sum += value;
    for (Eigen::RowVectorXd const& slopes : p.derivative) sum += slopes.sum();
    if (!std::isfinite(sum) || p.value[0] == 0) return;
    NextExperiment next =
        judged(p, conditions_[p.condition], now_, reading_error(study_, p.quantity), sigma_, rivals_.names);
    screened_.emplace_back(std::move(next), std::move(p));
  }

  /// True runs at the best few places.
  void simulate() {
    std::vector<std::size_t> chosen;
    for (auto const& [next, p] : screened_) {
      bool const there = std::ranges::find(chosen, p.condition) != chosen.end();
      if (!there && chosen.size() < simulated_proposals) chosen.push_back(p.condition);
    }
    std::vector<Condition> conditions;
    std::vector<std::size_t> origin;
    for (std::size_t const c : chosen) conditions.push_back(conditions_[c]), origin.push_back(origin_[c]);
    std::set<std::string> quantities;
    for (auto const& [next, p] : screened_) quantities.insert(p.quantity);
    if (chosen.empty()) return;
    auto const truth = predict_rivals(under(study_, conditions, origin), {quantities.begin(), quantities.end()},
                                      explained_.candidates, rivals_, model_of_, false);
    for (auto& [next, p] : screened_) {
      auto const at = std::ranges::find(chosen, p.condition);
      if (at == chosen.end()) continue;
      for (std::size_t r = 0; r < p.value.size(); ++r) p.value[r] = truth.at(p.quantity).value[r][at - chosen.begin()];
      if (!std::isfinite(p.value[0]) || p.value[0] == 0) continue;
      found_.push_back(
          judged(p, conditions_[p.condition], now_, reading_error(study_, p.quantity), sigma_, rivals_.names));
      found_.back().simulated = true;
    }
  }

  Explanation const& explained_;
  Study const& study_;
  ModelOf const& model_of_;
  RivalFits rivals_;
  Standing now_;
  double sigma_ = 1;
  std::vector<Condition> conditions_;
  std::vector<std::size_t> origin_;
  std::vector<std::pair<NextExperiment, Proposal>> screened_;
  std::vector<NextExperiment> found_;
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
