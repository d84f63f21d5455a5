#include "coupling/grain_clearance.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::coupling {
namespace {

constexpr int most_sweeps = 300;
constexpr int sweeps_before_lifting = 60;
constexpr double gap = 1e-4;            ///< [radii] left between grain and surface
constexpr double extra_overlap = 1e-3;  ///< [radii] a pair may gain
constexpr double lift = 0.1;            ///< [radii] by which a grain that is wedged in rises per sweep

/// Columns of grains seen from above, rebuilt each sweep.
class Bins {
 public:
  Bins(PowderBed const& bed, double width) : bed_(bed) {
    double const largest = *std::max_element(bed.radius.begin(), bed.radius.end());
    x0_ = *std::min_element(bed.x.begin(), bed.x.end());
    double const length = *std::max_element(bed.x.begin(), bed.x.end()) - x0_;
    nx_ = static_cast<std::int64_t>(length / (2.5 * largest)) + 1;
    ny_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(width / (2.5 * largest)));
    edge_x_ = length / static_cast<double>(nx_) + 1e-12;
    edge_y_ = width / static_cast<double>(ny_);
    rebuild();
  }
  void rebuild() {
    rows_.assign(static_cast<std::size_t>(nx_ * ny_), {});
    for (std::size_t g = 0; g < bed_.size(); ++g) rows_[static_cast<std::size_t>(i_of(g) + nx_ * j_of(g))].push_back(g);
  }
  /// Rows near grain g in ascending order, itself included.
  std::vector<std::size_t> near(std::size_t g) const {
    std::vector<std::size_t> found;
    std::vector<std::int64_t> bins;
    for (std::int64_t di = -1; di <= 1; ++di) {
      std::int64_t const i = i_of(g) + di;
      if (i < 0 || i >= nx_) continue;
      for (std::int64_t dj = -1; dj <= 1; ++dj) bins.push_back(i + nx_ * ((j_of(g) + dj + ny_) % ny_));
    }
    std::sort(bins.begin(), bins.end());
    bins.erase(std::unique(bins.begin(), bins.end()), bins.end());
    for (std::int64_t b : bins)
      found.insert(found.end(), rows_[static_cast<std::size_t>(b)].begin(), rows_[static_cast<std::size_t>(b)].end());
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  std::int64_t i_of(std::size_t g) const {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>((bed_.x[g] - x0_) / edge_x_), 0, nx_ - 1);
  }
  std::int64_t j_of(std::size_t g) const {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(bed_.y[g] / edge_y_), 0, ny_ - 1);
  }

  PowderBed const& bed_;
  double x0_, edge_x_, edge_y_;
  std::int64_t nx_, ny_;
  std::vector<std::vector<std::size_t>> rows_;
};

class Relaxation {
 public:
  Relaxation(PowderBed& bed, SurfaceDistance const& surface, Case const& checked)
      : bed_(bed),
        surface_(surface),
        machine_(checked.machine),
        bins_(bed, checked.machine.width),
        active_(bed.size(), 0) {
    for (std::size_t g = 0; g < bed.size(); ++g) start_.push_back(bed.position(g));
    for (std::size_t g = 0; g < bed.size(); ++g) active_[g] = touches_surface(g);
  }

  /// True once a whole sweep found nothing to correct.
  bool run() {
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      stuck_.clear();
      lifting_ = sweep >= sweeps_before_lifting;
      for (std::size_t g = 0; g < bed_.size(); ++g) {
        if (active_[g] && correct(g)) stuck_.push_back(g);
      }
      if (stuck_.empty()) return true;
      bins_.rebuild();
    }
    return false;
  }

  double displacement(std::size_t g) const { return from_to(start_[g], bed_.position(g)).norm(); }
  /// Puts every grain back and returns those that found no place: where there are such, the ones at the surface.
  std::vector<std::size_t> undo() {
    for (std::size_t g = 0; g < bed_.size(); ++g) place(g, start_[g]);
    std::vector<std::size_t> at_surface;
    std::copy_if(stuck_.begin(), stuck_.end(), std::back_inserter(at_surface),
                 [&](std::size_t g) { return touches_surface(g); });
    return at_surface.empty() ? stuck_ : at_surface;
  }

 private:
  Vec3 from_to(Vec3 const& a, Vec3 const& b) const {
    Vec3 d = b - a;
    d.y() -= machine_.width * std::round(d.y() / machine_.width);
    return d;
  }

  void place(std::size_t g, Vec3 p) {
    p.y() -= machine_.width * std::floor(p.y() / machine_.width);
    if (p.y() >= machine_.width) p.y() = 0;  // -1e-300 wraps to width itself
    bed_.x[g] = p.x();
    bed_.y[g] = p.y();
    bed_.z[g] = p.z();
  }

  bool touches_surface(std::size_t g) const {
    Vec3 const p = bed_.position(g);
    Vec3 const away = p - surface_.closest_point(p);
    double const reach = bed_.radius[g] * (1 + 0.5 * gap);
    return away.squaredNorm() < reach * reach || surface_.encloses(p);
  }

  /// All corrections of one grain; true when there was any. The surface comes last: it is the hard one.
  bool correct(std::size_t g) {
    bool corrected = false;
    for (std::size_t h : bins_.near(g)) corrected = (h != g && separate(g, h)) || corrected;
    corrected = keep_inside_pit(g) || corrected;
    return leave_surface(g) || corrected;
  }

  bool separate(std::size_t g, std::size_t h) {
    double const reach = bed_.radius[g] + bed_.radius[h];
    Vec3 const d = from_to(bed_.position(g), bed_.position(h));
    if (d.squaredNorm() >= reach * reach) return false;
    double const before = std::max(0.0, reach - from_to(start_[g], start_[h]).norm());
    double const allowed = before + extra_overlap * std::min(bed_.radius[g], bed_.radius[h]);
    double const distance = d.norm(), overlap = reach - distance;
    if (overlap <= allowed) return false;
    active_[g] = active_[h] = 1;
    double const wanted = reach - before - 0.5 * (allowed - before);
    if (lifting_) {
      std::size_t const upper = d.z() > 0 || (d.z() == 0 && h > g) ? h : g;
      double const across = std::hypot(d.x(), d.y());
      double const rise = std::sqrt(std::max(0.0, wanted * wanted - across * across)) - std::abs(d.z());
      place(upper, bed_.position(upper) + Vec3(0, 0, std::max(rise, 0.0)));
      return true;
    }
    Vec3 const push = 0.5 * (wanted - distance) * (distance > 0 ? Vec3(d / distance) : Vec3(0, 0, 1));
    place(g, bed_.position(g) - push);
    place(h, bed_.position(h) + push);
    return true;
  }

  /// Grains in the pit stay between its walls, but are not pushed off a wall that they pressed on before.
  bool keep_inside_pit(std::size_t g) {
    double const begin = machine_.deposition_begin(), end = machine_.deposition_end(), r = bed_.radius[g];
    if (bed_.z[g] >= r || start_[g].x() < begin || start_[g].x() > end) return false;
    double const left = std::min(begin + r, start_[g].x()), right = std::max(end - r, start_[g].x());
    double const x = std::clamp(bed_.x[g], left, std::max(left, right));
    bool const moved = std::abs(x - bed_.x[g]) > extra_overlap * r;
    bed_.x[g] = x;
    return moved;
  }

  bool leave_surface(std::size_t g) {
    if (!touches_surface(g)) return false;
    Vec3 const p = bed_.position(g);
    Vec3 const nearest = surface_.closest_point(p);
    double const side = surface_.encloses(p) ? -1.0 : 1.0;
    double const distance = (p - nearest).norm();
    Vec3 const away = distance > 0 ? Vec3(side * (p - nearest) / distance) : Vec3(0, 0, 1);
    Vec3 target = nearest + (1 + gap) * bed_.radius[g] * away;
    if (lifting_) target += Vec3(0, 0, lift * bed_.radius[g]);
    place(g, target);
    return true;
  }

  PowderBed& bed_;
  SurfaceDistance const& surface_;
  MachineSettings const& machine_;
  Bins bins_;
  std::vector<char> active_;
  std::vector<Vec3> start_;
  std::vector<std::size_t> stuck_;
  bool lifting_ = false;
};

}  // namespace

Clearance clear_grains(PowderBed& bed, SurfaceDistance const& surface, Case const& checked) {
  Clearance clearance;
  if (bed.size() == 0) return clearance;
  Relaxation relaxation(bed, surface, checked);
  if (!relaxation.run()) {
    clearance.stuck = relaxation.undo();
    return clearance;
  }
  std::vector<std::int64_t> moved;
  for (std::size_t g = 0; g < bed.size(); ++g) {
    double const displacement = relaxation.displacement(g);
    clearance.largest_displacement = std::max(clearance.largest_displacement, displacement);
    if (displacement > extra_overlap * bed.radius[g]) moved.push_back(bed.id[g]);
  }
  clearance.grains_moved = static_cast<std::int64_t>(moved.size());
  auto const is_moved = [&](std::int64_t id) { return std::binary_search(moved.begin(), moved.end(), id); };
  std::erase_if(bed.contacts, [&](ContactSpring const& c) { return is_moved(c.key_a) || is_moved(c.key_b); });
  return clearance;
}

}  // namespace layerloop::coupling
