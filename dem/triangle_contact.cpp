#include "dem/triangle_contact.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::dem {
namespace {
constexpr double same_distance = 1e-15;  // [m]: rounding of coordinates of millimetres
constexpr double same_normal = 0.951;    // cosine of 18 degrees

bool has_feature(TriangleSurface const& surface, std::int32_t triangle, TriangleContact const& contact) {
  auto const& corners = surface.triangles[static_cast<std::size_t>(triangle)];
  auto const& own = surface.triangles[static_cast<std::size_t>(contact.triangle)];
  for (unsigned c = 0; c < 3; ++c) {
    if ((contact.corners >> c & 1U) && std::ranges::find(corners, own[c]) == corners.end()) return false;
  }
  return true;
}

/// Does the surface come nearer to the sphere than at `contact` in a triangle that shares its edge or corner?
bool is_hidden(TriangleSurface const& surface, std::vector<TriangleContact> const& contacts,
               TriangleContact const& contact) {
  if (contact.corners == 7) return false;
  return std::ranges::any_of(contacts, [&](TriangleContact const& other) {
    if (other.triangle == contact.triangle || !has_feature(surface, other.triangle, contact)) return false;
    if (other.distance < contact.distance - same_distance) return true;
    if (other.distance > contact.distance + same_distance) return false;
    return other.corners == 7 || other.triangle < contact.triangle;
  });
}
}  // namespace

TrianglePoint nearest_on_triangle(Vec3 const& a, Vec3 const& b, Vec3 const& c, Vec3 const& p) {
  Vec3 const ab = b - a, ac = c - a, ap = p - a;
  double const d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, 1};
  Vec3 const bp = p - b;
  double const d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, 2};
  double const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, 3};
  Vec3 const cp = p - c;
  double const d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, 4};
  double const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, 5};
  double const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return {b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b), 6};
  double const whole = va + vb + vc;
  return {a + vb / whole * ab + vc / whole * ac, 7};
}

TriangleContact contact_with(TriangleSurface const& surface, std::int32_t t, Vec3 const& p) {
  auto const row = static_cast<std::size_t>(t);
  Vec3 const &a = surface.corner(row, 0), &b = surface.corner(row, 1), &c = surface.corner(row, 2);
  TrianglePoint const near = nearest_on_triangle(a, b, c, p);
  if (near.corners == 7) {
    Vec3 const normal = surface.normal(row);
    return {t, 7, normal.dot(p - a), normal};
  }
  Vec3 const away = p - near.point;
  double const distance = away.norm();
  return {t, near.corners, distance, distance > 0 ? Vec3(away / distance) : surface.normal(row)};
}

void merge_contacts(TriangleSurface const& surface, std::vector<TriangleContact>& contacts) {
  if (contacts.size() < 2) return;
  std::ranges::sort(contacts, [](TriangleContact const& a, TriangleContact const& b) {
    double const da = std::abs(a.distance), db = std::abs(b.distance);
    return da != db ? da < db : a.triangle < b.triangle;
  });
  // the far side of a thin place is behind the near side: only a centre that is inside the solid has a back face
  // nearest
  if (contacts.front().distance >= 0)
    std::erase_if(contacts, [](TriangleContact const& contact) { return contact.distance < 0; });
  for (TriangleContact& contact : contacts) contact.hidden = is_hidden(surface, contacts, contact);
  std::erase_if(contacts, [](TriangleContact const& contact) { return contact.hidden; });
  std::size_t kept = 0;
  for (TriangleContact const& contact : contacts) {
    auto const same_place = [&](TriangleContact const& other) {
      return other.normal.dot(contact.normal) > same_normal;
    };
    if (std::none_of(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(kept), same_place))
      contacts[kept++] = contact;
  }
  contacts.resize(kept);
}

TriangleGrid::TriangleGrid(TriangleSurface const& surface, double cell) : cell_(cell) {
  if (surface.triangles.empty()) return;
  low_ = high_ = surface.vertices.front();
  for (Vec3 const& v : surface.vertices) {
    low_ = low_.cwiseMin(v);
    high_ = high_.cwiseMax(v);
  }
  constexpr double most_cells = 2e6;
  Vec3 const extent = high_ - low_;
  while ((extent / cell_ + Vec3::Ones()).prod() > most_cells) cell_ *= 2;
  for (int d = 0; d < 3; ++d) n_[static_cast<std::size_t>(d)] = static_cast<std::int32_t>(extent[d] / cell_) + 1;

  std::vector<std::int32_t> count(static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(n_[1] * n_[2]) + 1, 0);
  auto const for_cells_of = [&](std::size_t t, auto&& visit) {
    Vec3 const &a = surface.corner(t, 0), &b = surface.corner(t, 1), &c = surface.corner(t, 2);
    for_cells(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c), visit);
  };
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) for_cells_of(t, [&](std::size_t at) { ++count[at + 1]; });
  for (std::size_t at = 1; at < count.size(); ++at) count[at] += count[at - 1];
  begin_ = count;
  triangles_.resize(static_cast<std::size_t>(begin_.back()));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for_cells_of(
        t, [&](std::size_t at) { triangles_[static_cast<std::size_t>(count[at]++)] = static_cast<std::int32_t>(t); });
}

std::array<std::int32_t, 3> TriangleGrid::cell_of(Vec3 const& p) const {
  std::array<std::int32_t, 3> cell;
  for (int d = 0; d < 3; ++d) {
    auto const axis = static_cast<std::size_t>(d);
    cell[axis] = static_cast<std::int32_t>(std::clamp((p[d] - low_[d]) / cell_, 0.0, n_[axis] - 1.0));
  }
  return cell;
}

template <class Visit>
void TriangleGrid::for_cells(Vec3 const& low, Vec3 const& high, Visit&& visit) const {
  auto const from = cell_of(low), to = cell_of(high);
  for (std::int32_t k = from[2]; k <= to[2]; ++k)
    for (std::int32_t j = from[1]; j <= to[1]; ++j)
      for (std::int32_t i = from[0]; i <= to[0]; ++i)
        visit(static_cast<std::size_t>(i + std::int64_t{n_[0]} * (j + std::int64_t{n_[1]} * k)));
}

void TriangleGrid::find(Vec3 const& centre, double radius, std::vector<std::int32_t>& triangles) const {
  triangles.clear();
  if (triangles_.empty()) return;
  Vec3 const reach = Vec3::Constant(radius), low = centre - reach, high = centre + reach;
  if ((low.array() > high_.array()).any() || (high.array() < low_.array()).any()) return;
  for_cells(low, high, [&](std::size_t at) {
    triangles.insert(triangles.end(), triangles_.begin() + begin_[at], triangles_.begin() + begin_[at + 1]);
  });
  std::ranges::sort(triangles);
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
}

}  // namespace layerloop::dem
