#pragma once
#include <optional>
#include <string>
#include <vector>

#include "validation/blind/forecast.hpp"
#include "validation/blind/judgement.hpp"
#include "validation/blind/scenario.hpp"

namespace layerloop::validation {

/// 95 % interval of a share, k of n (Wilson, J. Am. Stat. Assoc. 22 (1927) 209).
struct Interval {
  double low, high;
};
Interval wilson(std::size_t k, std::size_t n);

/// One scenario after it was opened.
struct Opened {
  Answer answer;
  Judgement judgement;
  Forecast forecast;
  std::vector<Judgement> others;  ///< of baselines, ablations: the same methods in the same order everywhere
};

/// One line of the score table.
struct Score {
  std::string name, of;  ///< what is counted, and among which scenarios
  bool is_share = true;
  std::size_t hits = 0, n = 0;  ///< of a share
  double value = 0;             ///< share, or figure
  Interval interval{0, 1};      ///< of a share
  bool high_is_good = true;
  double minimum = 0, target = 0;          ///< not a number: no bar
  std::vector<std::string> failures = {};  ///< ids

  bool passes() const;           ///< the value is beyond the minimum
  bool passes_for_sure() const;  ///< the bound of the interval is
};

/// The table of the protocol. \param method  nothing: the judgement; else the number of one of the others
std::vector<Score> scores_of(std::vector<Opened> const& all, std::optional<std::size_t> method = {});

/// Shares of scenarios with one effect whose first name is right, over bins of visibility or of the largest cosine.
struct CurvePoint {
  double from, to;
  std::size_t hits, n;
};
std::vector<CurvePoint> named_over_visibility(std::vector<Opened> const& all);
std::vector<CurvePoint> named_over_cosine(std::vector<Opened> const& all);

}  // namespace layerloop::validation
