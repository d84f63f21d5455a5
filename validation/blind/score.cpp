#include "validation/blind/score.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace layerloop::validation {

Interval wilson(std::size_t k, std::size_t n) {
  if (n == 0) return {0, 1};
  constexpr double z = 1.959963984540054;
  auto const trials = static_cast<double>(n);
  double const share = static_cast<double>(k) / trials, spread = z * z / trials;
  double const centre = (share + spread / 2) / (1 + spread);
  double const half = z / (1 + spread) * std::sqrt(share * (1 - share) / trials + spread / (4 * trials));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

bool Score::passes() const { return std::isnan(minimum) || (high_is_good ? value >= minimum : value <= minimum); }

bool Score::passes_for_sure() const {
  if (!is_share) return passes();
  return high_is_good ? interval.low >= minimum : interval.high <= minimum;
}

namespace {

using enum ScenarioClass;
using Among = std::function<bool(Answer const&)>;
using Judged = std::function<bool(Opened const&, Judgement const&)>;

Among in_class(ScenarioClass kind, double visibility = 0) {
  return [=](Answer const& answer) { return answer.kind == kind && answer.visibility() >= visibility; };
}

bool is_clear_effect(Answer const& answer, double visibility) {
  return answer.kind == one_effect && answer.visibility() >= visibility && answer.largest_cosine <= 0.9;
}

bool is_unknown(Answer const& answer) {
  bool const hidden = answer.kind == foreign_cause || (answer.kind == withheld_effect && answer.largest_cosine <= 0.95);
  return hidden && answer.visibility() >= 10;
}

bool says(Judgement const& judgement, std::vector<std::string> const& verdicts) {
  return std::ranges::find(verdicts, judgement.verdict) != verdicts.end();
}

bool is_named_first(Opened const& one, Judgement const& judgement) {
  return says(judgement, {"IDENTIFIED", "GROUP", "IDENTIFIED_FORM_IMPERFECT"}) && !judgement.named.empty() &&
         judgement.named.front().name == one.answer.causes.front().name;
}

bool is_in_set(Opened const& one, Judgement const& judgement) {
  return !says(judgement, {"UNKNOWN", "CONSISTENT", "NOISE"}) && judgement.contains(one.answer.causes.front().name);
}

bool names_both(Opened const& one, Judgement const& judgement) {
  return std::ranges::all_of(one.answer.causes,
                             [&](HiddenCause const& cause) { return judgement.contains(cause.name); });
}

bool names_another(Opened const& one, Judgement const& judgement) {
  return judgement.names_physics() && std::ranges::any_of(judgement.named, [&](Judgement::Named const& named) {
           return named.is_physics && std::ranges::none_of(one.answer.causes, [&](HiddenCause const& cause) {
                    return named.name == cause.name || std::ranges::find(named.group, cause.name) != named.group.end();
                  });
         });
}

bool shows_pattern(Opened const& one, Judgement const& judgement) {
  auto const has = [](std::string const& text, std::vector<std::string> const& words) {
    return std::ranges::any_of(words, [&](std::string const& word) { return text.find(word) != std::string::npos; });
  };
  return std::ranges::any_of(judgement.patterns, [&](std::string const& text) {
    return has(text, one.answer.variables) && has(text, one.answer.quantities);
  });
}

class Table {
 public:
  Table(std::vector<Opened> const& all, std::optional<std::size_t> method) : all_(all), method_(method) {}
  std::vector<Score> scores;

  void share(std::string const& name, std::string const& of, Among const& among, Judged const& hit, bool high_is_good,
             double minimum, double target) {
    Score score{name, of, true, 0, 0, 0, {0, 1}, high_is_good, minimum, target, {}};
    for (Opened const& one : all_) {
      if (!among(one.answer)) continue;
      bool const hits = hit(one, judgement(one));
      score.n += 1, score.hits += hits ? 1 : 0;
      if (hits != high_is_good) score.failures.push_back(one.answer.id);
    }
    score.value = score.n ? static_cast<double>(score.hits) / static_cast<double>(score.n) : NAN;
    score.interval = wilson(score.hits, score.n);
    scores.push_back(score);
  }

  enum class Take { mean, median };

  void figure(std::string const& name, std::string const& of, Among const& among,
              std::function<std::optional<double>(Opened const&, Judgement const&)> const& read, Take take,
              bool high_is_good, double minimum, double target) {
    std::vector<double> values;
    for (Opened const& one : all_)
      if (among(one.answer))
        if (auto const value = read(one, judgement(one)); value && std::isfinite(*value)) values.push_back(*value);
    std::ranges::sort(values);
    Score score{name, of, false, 0, values.size(), NAN, {0, 1}, high_is_good, minimum, target, {}};
    auto const n = static_cast<double>(values.size());
    if (!values.empty() && take == Take::median)
      score.value = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
    if (!values.empty() && take == Take::mean) {
      score.value = 0;
      for (double const v : values) score.value += v / n;
    }
    scores.push_back(score);
  }

 private:
  Judgement const& judgement(Opened const& one) const { return method_ ? one.others[*method_] : one.judgement; }

  std::vector<Opened> const& all_;
  std::optional<std::size_t> method_;
};

void add_names(Table& table) {
  constexpr bool high = true, low = false;
  auto const clear = [](Answer const& answer) { return is_clear_effect(answer, 8); };
  table.share("named right at once", "one effect, lambda >= 8, no other within cosine 0.9", clear, is_named_first, high,
              0.90, 0.95);
  table.share("truth among what is named", "one effect, lambda >= 5", in_class(one_effect, 5), is_in_set, high, 0.95,
              0.97);
  table.figure(
      "mean number of names in that set", "one effect, lambda >= 5", in_class(one_effect, 5),
      [](Opened const& one, Judgement const& judgement) -> std::optional<double> {
        if (!is_in_set(one, judgement)) return std::nullopt;
        return static_cast<double>(judgement.set_size());
      },
      Table::Take::mean, low, 2.0, 1.6);
  table.share("both named", "two effects, each lambda >= 8", in_class(two_effects, 8), names_both, high, 0.80, 0.90);
  table.share("another one named too", "two effects, each lambda >= 8", in_class(two_effects, 8), names_another, low,
              0.10, 0.05);
  table.share(
      "declared a group", "twins", in_class(twins, 5),
      [](Opened const& one, Judgement const& j) { return j.verdict == "GROUP" && is_in_set(one, j); }, high, 0.90,
      0.95);
  table.share(
      "named as such", "cells, offsets, scales, lambda >= 5", in_class(not_physics, 5),
      [](Opened const& one, Judgement const& j) {
        return says(j, {"NUMERICS", "INSTRUMENT"}) && is_in_set(one, j);
      },
      high, 0.90, 0.95);
}

void add_refusals(Table& table) {
  constexpr bool high = true, low = false;
  auto const claims = [](Opened const&, Judgement const& judgement) { return judgement.names_physics(); };
  table.share("false claim of physics", "nothing hidden", in_class(nothing), claims, low, 0.03, 0.01);
  table.share("false claim of physics", "wrong calibration", in_class(wrong_calibration), claims, low, 0.05, 0.02);
  table.share("false claim of physics", "outliers, understated noise, omitted error", in_class(bad_noise), claims, low,
              0.05, 0.02);
  table.share("false claim of physics", "what real data carry", in_class(real_life), claims, low, 0.05, 0.02);
  table.share(
      "recognised as unknown", "not among the candidates, lambda >= 10, no twin", is_unknown,
      [](Opened const&, Judgement const& j) {
        return says(j, {"UNKNOWN", "CONFOUNDED"});
      },
      high, 0.90, 0.95);
  table.share(
      "a wrong name", "not among the candidates, lambda >= 10, no twin", is_unknown,
      [](Opened const& one, Judgement const& j) {
        return says(j, {"IDENTIFIED", "GROUP", "IDENTIFIED_FORM_IMPERFECT"}) && names_another(one, j);
      },
      low, 0.05, 0.02);
  table.share("right pattern shown", "in no catalogue, lambda >= 10", in_class(foreign_cause, 10), shows_pattern, high,
              0.60, 0.80);
}

void add_figures(Table& table) {
  constexpr bool high = true, low = false;
  auto const clear = [](Answer const& answer) { return is_clear_effect(answer, 8); };
  auto const strong = [](Answer const& answer) { return is_clear_effect(answer, 10); };
  using Value = std::optional<double>;
  auto const named = [](Opened const& one, Judgement const& j) { return is_named_first(one, j); };
  table.figure(
      "median relative error of the strength", "one effect, lambda >= 8, named right", clear,
      [=](Opened const& one, Judgement const& j) -> Value {
        double const truth = one.answer.strengths.front();
        if (!named(one, j) || truth == 0) return std::nullopt;
        return std::abs(j.named.front().strength / truth - 1);
      },
      Table::Take::median, low, 0.20, 0.10);
  table.figure(
      "strengths inside their 95 % interval", "one effect, lambda >= 8, named right", clear,
      [=](Opened const& one, Judgement const& j) -> Value {
        if (!named(one, j)) return std::nullopt;
        double const off = j.named.front().strength - one.answer.strengths.front();
        return std::abs(off) <= 1.96 * j.named.front().u_strength ? 1.0 : 0.0;
      },
      Table::Take::mean, high, 0.88, 0.92);
  table.figure(
      "held-out error before over after, median", "one effect, lambda >= 10", strong,
      [](Opened const& one, Judgement const&) -> Value { return one.forecast.calibrated / one.forecast.named; },
      Table::Take::median, high, 2, 3);
  table.figure(
      "the same of a nameless smooth correction", "one effect, lambda >= 10", strong,
      [](Opened const& one, Judgement const&) -> Value { return one.forecast.calibrated / one.forecast.smooth; },
      Table::Take::median, high, NAN, NAN);
  table.figure(
      "whitened held-out error after, median", "one effect, lambda >= 10", strong,
      [](Opened const& one, Judgement const&) -> Value { return one.forecast.whitened; }, Table::Take::median, low, 1.5,
      1.2);
  table.figure(
      "passes over the data, mean", "all", [](Answer const&) { return true; },
      [](Opened const&, Judgement const& j) -> Value { return j.passes; }, Table::Take::mean, low, 60, 30);
}

std::vector<CurvePoint> curve(std::vector<Opened> const& all, std::vector<double> const& edges,
                              std::function<double(Answer const&)> const& over, Among const& among) {
  std::vector<CurvePoint> points;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    CurvePoint point{edges[i], edges[i + 1], 0, 0};
    for (Opened const& one : all) {
      if (one.answer.kind != one_effect || !among(one.answer)) continue;
      if (double const x = over(one.answer); x < point.from || x >= point.to) continue;
      point.n += 1, point.hits += is_named_first(one, one.judgement) ? 1 : 0;
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace

std::vector<Score> scores_of(std::vector<Opened> const& all, std::optional<std::size_t> method) {
  Table table(all, method);
  add_names(table);
  add_refusals(table);
  if (!method) add_figures(table);
  return table.scores;
}

std::vector<CurvePoint> named_over_visibility(std::vector<Opened> const& all) {
  return curve(
      all, {0, 3, 4.5, 6, 8, 12, 18, 35}, [](Answer const& answer) { return answer.visibility(); },
      [](Answer const& answer) { return answer.largest_cosine <= 0.9; });
}

std::vector<CurvePoint> named_over_cosine(std::vector<Opened> const& all) {
  return curve(
      all, {0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1.01}, [](Answer const& answer) { return answer.largest_cosine; },
      [](Answer const& answer) { return answer.visibility() >= 8; });
}

}  // namespace layerloop::validation
