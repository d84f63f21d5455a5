#include "dem/disc_union.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/compensated_sum.hpp"

namespace layerloop::dem {
namespace {
constexpr double two_pi = 2 * std::numbers::pi;

/// Angles of one rim that other discs cover; angles lie in [0, 2 pi].
class Covered {
 public:
  void add(double middle, double half_angle) {
    double from = std::fmod(middle - half_angle, two_pi);
    if (from < 0) from += two_pi;
    double const to = from + 2 * half_angle;
    intervals_.emplace_back(from, std::min(to, two_pi));
    if (to > two_pi) intervals_.emplace_back(0.0, to - two_pi);
  }

  /// visit(from, to) for every bare piece.
  template <class Visit>
  void for_each_gap(Visit const& visit) {
    std::ranges::sort(intervals_);
    double end = 0;
    for (auto const& [from, to] : intervals_) {
      if (from > end) visit(end, from);
      end = std::max(end, to);
    }
    if (end < two_pi) visit(end, two_pi);
  }

 private:
  std::vector<std::pair<double, double>> intervals_;
};

enum class Cover { none, part, whole };

/// What a disc at (dx, dy) from another hides of the other's rim. \param first  of two equal discs, this one stays
Cover cover(double radius, double other_radius, double distance, bool first) {
  if (distance >= radius + other_radius || distance < radius - other_radius) return Cover::none;
  if (distance == 0 && radius == other_radius) return first ? Cover::none : Cover::whole;
  if (distance <= other_radius - radius) return Cover::whole;
  return distance == radius - other_radius ? Cover::none : Cover::part;
}

/// Primitive of clamp(x + r cos t, low, high) r cos t over a piece that stays on one side of both bounds.
double piece_area(RimArc const& arc, double from, double to, double low, double high) {
  double const r = arc.radius, middle = arc.x + r * std::cos(0.5 * (from + to));
  double const rise = r * (std::sin(to) - std::sin(from));
  if (middle <= low) return low * rise;
  if (middle >= high) return high * rise;
  return arc.x * rise + r * r * (0.5 * (to - from) + 0.25 * (std::sin(2 * to) - std::sin(2 * from)));
}

/// Angles where the circle meets x = at.
std::array<double, 2> crossings(RimArc const& arc, double at) {
  double const c = (at - arc.x) / arc.radius;
  if (!(std::abs(c) < 1)) return {-1, -1};
  double const t = std::acos(c);
  return {t, two_pi - t};
}
}  // namespace

std::vector<RimArc> rim_of_union(std::vector<Disc> discs, double period) {
  std::ranges::sort(discs, {}, [](Disc const& d) { return std::tuple(d.x, d.y, d.radius); });
  double largest = 0;
  for (Disc const& d : discs) largest = std::max(largest, d.radius);
  int const images = static_cast<int>(std::ceil(2 * largest / period));
  std::vector<RimArc> rim;
  for (std::size_t i = 0; i < discs.size(); ++i) {
    Disc const& own = discs[i];
    Covered covered;
    bool hidden = false;
    auto const first = std::ranges::lower_bound(discs, own.x - own.radius - largest, {}, &Disc::x) - discs.begin();
    for (auto j = static_cast<std::size_t>(first); j < discs.size() && !hidden; ++j) {
      if (discs[j].x > own.x + own.radius + largest) break;
      double const dx = discs[j].x - own.x, nearest = std::remainder(discs[j].y - own.y, period);
      for (int k = -images; k <= images && !hidden; ++k) {
        double const dy = nearest + k * period, distance = std::hypot(dx, dy);
        if (i == j && dy == 0) continue;
        Cover const how = cover(own.radius, discs[j].radius, distance, i < j);
        hidden = how == Cover::whole;
        if (how != Cover::part) continue;
        double const r = own.radius, s = discs[j].radius;
        double const cosine = (distance * distance + r * r - s * s) / (2 * distance * r);
        covered.add(std::atan2(dy, dx), std::acos(std::clamp(cosine, -1.0, 1.0)));
      }
    }
    if (!hidden) covered.for_each_gap([&](double from, double to) { rim.push_back({own.x, own.radius, from, to}); });
  }
  return rim;
}

double area_between(std::vector<RimArc> const& rim, double low, double high) {
  CompensatedSum area;
  for (RimArc const& arc : rim) {
    auto const [a, b] = crossings(arc, low);
    auto const [c, d] = crossings(arc, high);
    std::array<double, 6> cuts{arc.from, a, b, c, d, arc.to};
    for (double& cut : cuts) cut = std::clamp(cut, arc.from, arc.to);
    std::ranges::sort(cuts);
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) area.add(piece_area(arc, cuts[k], cuts[k + 1], low, high));
  }
  return area.value();
}

}  // namespace layerloop::dem
