#include "validation/pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/gamma.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "validation/largest_null.hpp"

namespace layerloop::validation {
namespace {

/// A number that observations have, over which residuals may vary.
struct Variable {
  std::string words;  ///< "rises with laser.power"
  std::vector<double> values;
  bool is_level = false;  ///< 0 or 1: no products of it
  bool is_order = false;
};

/// To mean 0 and largest 1, so that products are of shapes and not of sizes; 0 where there is no value (a bare plate
/// has no layer thickness). False where it does not vary.
bool centre(std::vector<double>& values) {
  double sum = 0, count = 0, largest = 0;
  for (double const v : values)
    if (std::isfinite(v)) sum += v, count += 1;
  double const mean = sum / std::max(1.0, count);
  for (double& v : values) {
    v = std::isfinite(v) ? v - mean : 0.0;
    largest = std::max(largest, std::abs(v));
  }
  if (!(largest > 1e-12 * std::abs(mean))) return false;
  for (double& v : values) v /= largest;
  return true;
}

class Variables {
 public:
  explicit Variables(Study const& study) : study_(study) {
    add_inputs();
    add_places();
    add_labels();
    add_order();
  }
  std::vector<Variable> all;

 private:
  using Reading = std::function<double(Observation const&)>;

  std::vector<double> read(Reading const& reading) const {
    std::vector<double> values;
    for (Observation const& seen : study_.observations) values.push_back(reading(seen));
    return values;
  }

  Condition const& of(Observation const& seen) const { return study_.conditions[seen.condition]; }

  void add_line(std::string const& name, std::vector<double> values) {
    if (centre(values)) all.push_back({name, std::move(values)});
  }

  void add_inputs() {
    std::set<std::string> keys;
    for (Condition const& c : study_.conditions)
      for (auto const& [key, value] : c.inputs) keys.insert(key);
    for (std::string const& key : keys) {
      add_line(key, read([&](Observation const& seen) {
                 auto const found = of(seen).inputs.find(key);
                 return found == of(seen).inputs.end() ? NAN : found->second;
               }));
    }
  }

  void add_places() {
    auto const observable = [&](Observation const& seen) -> Observable const& {
      return study_.observables[seen.observable];
    };
    add_line("x", read([&](Observation const& seen) { return observable(seen).x.value_or(NAN); }));
    add_line("y", read([&](Observation const& seen) { return observable(seen).y.value_or(NAN); }));
    add_line("layer", read([&](Observation const& seen) { return observable(seen).layer.value_or(NAN); }));
  }

  void add_labels() {
    std::map<std::string, std::set<std::string>> levels;
    for (Observation const& seen : study_.observations)
      for (auto const& [label, level] : of(seen).labels) levels[label].insert(level);
    for (auto const& [label, names] : levels) {
      if (names.size() < 2) continue;
      for (std::string const& name : names) {
        all.push_back({fmt::format("{} {}", label, name), read([&](Observation const& seen) {
                         auto const found = of(seen).labels.find(label);
                         return found != of(seen).labels.end() && found->second == name ? 1.0 : 0.0;
                       }),
                       true});
      }
    }
  }

  /// A drift over the conditions in the order of acquisition, and jumps between them.
  void add_order() {
    auto const n = study_.conditions.size();
    add_line(order_of_acquisition, read([&](Observation const& seen) { return static_cast<double>(seen.condition); }));
    if (!all.empty() && all.back().words == order_of_acquisition) all.back().is_order = true;
    constexpr std::size_t most_jumps = 12;
    std::size_t const stride = std::max<std::size_t>(1, n / most_jumps);
    for (std::size_t first = stride; first + 1 < n; first += stride) {
      all.push_back({fmt::format("condition {} on", study_.conditions[first].id),
                     read([&](Observation const& seen) { return seen.condition >= first ? 1.0 : 0.0; }), true});
    }
  }

  Study const& study_;
};

}  // namespace

Patterns generic_patterns(Study const& study, Eigen::VectorXd const& predicted, Whitening const& whiten) {
  std::vector<Variable> const variables = Variables(study).all;
  std::set<std::string> quantities;
  for (Observation const& seen : study.observations) quantities.insert(seen.quantity);
  std::vector<std::string> rows(quantities.begin(), quantities.end());
  if (rows.size() > 1) rows.push_back("everything");

  Patterns found;
  std::vector<Eigen::VectorXd> columns;
  auto const n = static_cast<Eigen::Index>(study.observations.size());
  auto const add = [&](std::string const& quantity, std::string const& words, bool smooth, auto const& value) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      auto const k = static_cast<std::size_t>(i);
      if (quantity == "everything" || study.observations[k].quantity == quantity)
        column[i] = std::abs(predicted[i]) * value(k);
    }
    if (column.norm() == 0) return;
    columns.push_back(std::move(column));
    found.texts.push_back(fmt::format("{}: {}", quantity, words));
    found.smooth.push_back(smooth && quantity != "everything");
  };
  for (std::string const& quantity : rows) {
    add(quantity, "throughout", true, [](std::size_t) { return 1.0; });
    for (Variable const& v : variables)
      add(quantity, v.is_level ? v.words : "over " + v.words, !v.is_level && !v.is_order,
          [&](std::size_t k) { return v.values[k]; });
    for (std::size_t a = 0; a < variables.size(); ++a) {
      for (std::size_t b = a; b < variables.size(); ++b) {
        if (variables[a].is_level || variables[b].is_level) continue;
        add(quantity, fmt::format("over {} times {}", variables[a].words, variables[b].words),
            !variables[a].is_order && !variables[b].is_order,
            [&](std::size_t k) { return variables[a].values[k] * variables[b].values[k]; });
      }
    }
  }
  found.columns.resize(n, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) found.columns.col(static_cast<Eigen::Index>(k)) = columns[k];
  found.columns = whiten(found.columns);
  return found;
}

namespace {

/// Columns of one change: by quantity, on the observations where it holds.
Eigen::MatrixXd jump_columns(Study const& study, Eigen::VectorXd const& predicted,
                             std::function<bool(std::size_t condition)> const& holds) {
  std::map<std::string, Eigen::VectorXd> by_quantity;
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    Observation const& seen = study.observations[i];
    if (!holds(seen.condition)) continue;
    auto const row = static_cast<Eigen::Index>(i);
    by_quantity.try_emplace(seen.quantity, Eigen::VectorXd::Zero(predicted.size())).first->second[row] =
        std::abs(predicted[row]);
  }
  Eigen::MatrixXd columns(predicted.size(), static_cast<Eigen::Index>(by_quantity.size()));
  Eigen::Index k = 0;
  for (auto const& [quantity, column] : by_quantity) columns.col(k++) = column;
  return columns;
}

}  // namespace

std::vector<Jump> jumps_of(Study const& study, Eigen::VectorXd const& predicted, Whitening const& whiten) {
  std::vector<Jump> jumps;
  std::set<std::pair<std::string, std::string>> levels;
  std::set<std::size_t> seen_conditions;
  for (Observation const& seen : study.observations) {
    seen_conditions.insert(seen.condition);
    for (auto const& level : study.conditions[seen.condition].labels) levels.insert(level);
  }
  for (auto const& [label, level] : levels) {
    auto const holds = [&](std::size_t c) {
      auto const found = study.conditions[c].labels.find(label);
      return found != study.conditions[c].labels.end() && found->second == level;
    };
    if (std::ranges::all_of(seen_conditions, holds)) continue;
    jumps.push_back({label + " " + level, label, whiten(jump_columns(study, predicted, holds))});
  }
  for (std::size_t const first : seen_conditions) {
    if (first == *seen_conditions.begin()) continue;
    jumps.push_back({fmt::format("condition {} on", study.conditions[first].id), order_of_acquisition,
                     whiten(jump_columns(study, predicted, [first](std::size_t c) { return c >= first; }))});
  }
  return jumps;
}

PatternSearch::PatternSearch(Patterns const& patterns, Projection const& projection, LargestNull null)
    : unit_(projection(patterns.columns)), null_(std::move(null)) {
  Eigen::VectorXd const before = patterns.columns.colwise().norm();
  Eigen::Index kept = 0;
  for (Eigen::Index k = 0; k < unit_.cols(); ++k) {
    double const norm = unit_.col(k).norm();
    if (norm < 1e-3 * before[k]) continue;  // calibration can do all of it
    unit_.col(kept) = unit_.col(k) / norm;
    texts_.push_back(patterns.texts[static_cast<std::size_t>(k)]);
    if (patterns.smooth[static_cast<std::size_t>(k)]) smooth_.push_back(kept);
    ++kept;
  }
  unit_.conservativeResize(Eigen::NoChange, kept);
}

PatternSearch::PatternSearch(Patterns const& patterns, Projection const& projection, std::uint64_t seed)
    : PatternSearch(patterns, projection, LargestNull()) {
  null_ = LargestNull(unit_, std::vector<bool>(static_cast<std::size_t>(unit_.cols()), true), seed);
}

Structure PatternSearch::structure(Eigen::VectorXd const& residual, double scale) const {
  if (smooth_.empty()) return {};
  Eigen::MatrixXd const unit = unit_(Eigen::all, smooth_);
  double const mean = static_cast<double>(smooth_.size()), variance = 2 * (unit.transpose() * unit).squaredNorm();
  double const total = (unit.transpose() * residual).squaredNorm() / (scale * scale);
  boost::math::gamma_distribution<> const noise(mean * mean / variance, variance / mean);
  return {total - mean, boost::math::cdf(boost::math::complement(noise, total))};
}

std::vector<PatternFinding> PatternSearch::find(Eigen::VectorXd const& residual, double scale, std::size_t most) const {
  Eigen::VectorXd const z = unit_.transpose() * residual / scale;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(z.size()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](auto a, auto b) { return std::abs(z[a]) > std::abs(z[b]); });
  std::vector<PatternFinding> found;
  for (Eigen::Index const k : order) {
    if (found.size() == most) break;
    found.push_back({fmt::format("measured {} {}", z[k] > 0 ? "above" : "below", texts_[static_cast<std::size_t>(k)]),
                     z[k], null_.p(std::abs(z[k]))});
  }
  return found;
}

}  // namespace layerloop::validation
