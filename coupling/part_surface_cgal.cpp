#include "coupling/part_surface_cgal.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_3/Dump_c3t3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/facets_in_complex_3_to_triangle_mesh.h>
// Mesh_3 leaves a dump in the current folder before it throws; what it throws is dealt with here.
#define dump_c3t3(...) ((void)0)
#include <CGAL/make_mesh_3.h>
#include <CGAL/refine_mesh_3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "core/error.hpp"
#include "core/grain_size.hpp"
#include "coupling/surface_level.hpp"

namespace layerloop::coupling {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Domain = CGAL::Mesh_domain_with_polyline_features_3<CGAL::Labeled_mesh_domain_3<Kernel>>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

// Lengths are in cells, from the solid's origin, up to the last step: the same mesh wherever the plate stands.
constexpr double facet_distance = 0.1;  ///< between triangle and surface
constexpr double facet_angle = 25;      ///< smallest angle of a triangle [degrees]
constexpr double finest_facet = 1.3;    ///< circumradius where the surface is uneven
constexpr double coarsest_facet = 12;
constexpr double growth = 0.4;        ///< of the circumradius per cell of distance from uneven places
constexpr double crease_spacing = 4;  ///< of the vertices along the slab's edges
constexpr std::int64_t rim = 8;       ///< cells of bare plate around the meshed part
constexpr std::int64_t pit_wall = 6;  ///< cells that the slab reaches into the pit's walls
constexpr std::size_t vertices_per_column =
    8;                         ///< refinement stops there (an uneven surface takes 2); wrap() mends the rest
constexpr double snap = 1e-4;  ///< what lies so close to a plane of the slab is put onto it

/// Slab under zone, periodic continuation and rim; z = 0 is the plate's top.
struct Slab {
  Vec3 lower, upper;

  bool contains(Vec3 const& p) const {
    return (p.array() >= lower.array()).all() && (p.head<2>().array() <= upper.head<2>().array()).all();
  }
};

/// Where the surface is uneven, as the distance of each column from the next one that is [cells].
struct Unevenness {
  std::int64_t first_x, first_y, nx, ny;
  std::vector<double> distance;

  double at(double x, double y) const {
    auto const i = std::clamp(static_cast<std::int64_t>(std::floor(x)) - first_x, std::int64_t{0}, nx - 1);
    auto const j = std::clamp(static_cast<std::int64_t>(std::floor(y)) - first_y, std::int64_t{0}, ny - 1);
    return distance[static_cast<std::size_t>(i + nx * j)];
  }
};

/// More than one crossing on a column's axis: an overhang.
bool overhangs(SurfaceLevel const& level, std::int64_t i, std::int64_t j) {
  int crossings = 0;
  for (std::int64_t k = level.first[2]; k + 1 < level.first[2] + level.n[2]; ++k) {
    crossings += (level.at(i, j, k) >= 0.5) != (level.at(i, j, k + 1) >= 0.5);
  }
  return crossings > 1;
}

/// A column is uneven when its surface differs from the mean of its neighbours' by more than a triangle may.
bool is_uneven(SurfaceLevel const& level, std::vector<double> const& height, std::int64_t i, std::int64_t j) {
  auto const h = [&](std::int64_t di, std::int64_t dj) {
    auto const a = std::clamp(i + di - level.first[0], std::int64_t{0}, level.n[0] - 1);
    auto const b = std::clamp(j + dj - level.first[1], std::int64_t{0}, level.n[1] - 1);
    return height[static_cast<std::size_t>(a + level.n[0] * b)];
  };
  double const bend_x = h(-1, 0) + h(1, 0) - 2 * h(0, 0), bend_y = h(0, -1) + h(0, 1) - 2 * h(0, 0);
  double const twist = h(1, 1) - h(1, 0) - h(0, 1) + h(0, 0);
  return std::max({std::abs(bend_x), std::abs(bend_y), std::abs(twist)}) > 0.25 * facet_distance ||
         overhangs(level, i, j);
}

Unevenness find_unevenness(SurfaceLevel const& level) {
  Unevenness map{level.first[0], level.first[1], level.n[0], level.n[1], {}};
  std::vector<double> height;
  for (std::int64_t j = 0; j < map.ny; ++j) {
    for (std::int64_t i = 0; i < map.nx; ++i) height.push_back(level.top(i + map.first_x, j + map.first_y));
  }
  double const far = static_cast<double>(map.nx + map.ny);
  for (std::int64_t j = 0; j < map.ny; ++j) {
    for (std::int64_t i = 0; i < map.nx; ++i) {
      map.distance.push_back(is_uneven(level, height, i + map.first_x, j + map.first_y) ? 0.0 : far);
    }
  }
  // Two-pass distance transform (chamfer 1, sqrt 2).
  auto const relax = [&](std::int64_t i, std::int64_t j, std::int64_t di, std::int64_t dj) {
    if (i + di < 0 || i + di >= map.nx || j + dj < 0 || j + dj >= map.ny) return;
    double& d = map.distance[static_cast<std::size_t>(i + map.nx * j)];
    d = std::min(d, map.distance[static_cast<std::size_t>(i + di + map.nx * (j + dj))] + std::hypot(di, dj));
  };
  for (std::int64_t c = 0; c < map.nx * map.ny; ++c) {
    for (auto [di, dj] : {std::pair{-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) relax(c % map.nx, c / map.nx, di, dj);
  }
  for (std::int64_t c = map.nx * map.ny - 1; c >= 0; --c) {
    for (auto [di, dj] : {std::pair{1, 0}, {1, 1}, {0, 1}, {-1, 1}}) relax(c % map.nx, c / map.nx, di, dj);
  }
  return map;
}

struct FacetSize {
  using FT = double;
  using Point_3 = Point;
  using Index = Domain::Index;
  Unevenness const* uneven;

  double operator()(Point const& p, int, Index const&) const {
    return std::min(coarsest_facet, finest_facet + growth * uneven->at(p.x(), p.y()));
  }
};

/// The twelve edges of the slab as curves that the mesh must keep.
std::vector<std::vector<Point>> slab_edges(Slab const& slab) {
  auto const corner = [&](int c) {
    return Point(c & 1 ? slab.upper.x() : slab.lower.x(), c & 2 ? slab.upper.y() : slab.lower.y(),
                 c & 4 ? slab.upper.z() : slab.lower.z());
  };
  std::vector<std::vector<Point>> edges;
  for (int c = 0; c < 8; ++c) {
    for (int axis : {1, 2, 4}) {
      if (!(c & axis)) edges.push_back({corner(c), corner(c | axis)});
    }
  }
  return edges;
}

/// Points on the surface, on the axes of uneven columns, so that refinement overlooks no islet.
std::vector<Point> seeds(SurfaceLevel const& level, Unevenness const& uneven, double threshold) {
  std::vector<Point> points;
  for (std::int64_t j = level.first[1] + 1; j + 1 < level.first[1] + level.n[1]; ++j) {
    for (std::int64_t i = level.first[0] + 1; i + 1 < level.first[0] + level.n[0]; ++i) {
      double const x = static_cast<double>(i) + 0.5, y = static_cast<double>(j) + 0.5;
      if ((i + j) % 2 != 0 || uneven.at(x, y) > 0) continue;
      for (std::int64_t k = level.first[2]; k + 1 < level.first[2] + level.n[2]; ++k) {
        double const below = level.at(i, j, k), above = level.at(i, j, k + 1);
        if ((below >= threshold) == (above >= threshold)) continue;
        points.emplace_back(x, y, static_cast<double>(k) + 0.5 + (below - threshold) / (below - above));
      }
    }
  }
  return points;
}

/// \param threshold  fill at which metal begins: a half, or a little off to get round a degenerate arrangement
/// \throws CGAL::Failure_exception in degenerate arrangements (a point to insert that is there already)
Mesh refine(SurfaceLevel const& level, Slab const& slab, double threshold) {
  auto const inside = [&](Point const& p) {
    Vec3 const q(p.x(), p.y(), p.z());
    return slab.contains(q) && level(q) >= threshold ? 1 : 0;
  };
  double const height = static_cast<double>(level.n[2]) + 4;
  CGAL::Bbox_3 const box(slab.lower.x() - 4, slab.lower.y() - 4, slab.lower.z() - 4, slab.upper.x() + 4,
                         slab.upper.y() + 4, height);
  CGAL::Random random(0);
  Domain domain(std::function<int(Point const&)>(inside), box, CGAL::parameters::relative_error_bound = 1e-8,
                CGAL::parameters::p_rng = &random);
  auto const edges = slab_edges(slab);
  domain.add_features(edges.begin(), edges.end());

  namespace p = CGAL::parameters;
  Unevenness const uneven = find_unevenness(level);
  Criteria const coarse(p::edge_size = crease_spacing, p::facet_size = 2 * coarsest_facet);
  Criteria const fine(p::edge_size = crease_spacing, p::facet_angle = facet_angle, p::facet_size = FacetSize{&uneven},
                      p::facet_distance = facet_distance);
  Complex complex = CGAL::make_mesh_3<Complex>(domain, coarse, p::no_perturb(), p::no_exude(), p::manifold());
  for (Point const& seed : seeds(level, uneven, threshold)) {
    auto const vertex = complex.triangulation().insert(Triangulation::Weighted_point(seed));
    if (vertex == Complex::Vertex_handle()) continue;
    complex.set_dimension(vertex, 2);
    complex.set_index(vertex, domain.index_from_surface_patch_index({0, 1}));
  }
  std::size_t const limit = vertices_per_column * static_cast<std::size_t>(level.n[0] * level.n[1]) + 10000;
  CGAL::refine_mesh_3(complex, domain, fine, p::no_perturb(), p::no_exude(), p::manifold(),
                      p::mesh_3_options(p::maximal_number_of_vertices = limit));
  Mesh mesh;
  CGAL::facets_in_complex_3_to_triangle_mesh(complex, mesh);
  return mesh;
}

/// Bisection ends within 1e-8 of the truth; the plate's planes are known exactly.
void snap_to_slab(Mesh& mesh, Slab const& slab) {
  auto const put = [](double value, double lower, double upper) {
    return std::abs(value - lower) < snap ? lower : std::abs(value - upper) < snap ? upper : value;
  };
  for (auto v : mesh.vertices()) {
    Point const& p = mesh.point(v);
    mesh.point(v) = Point(put(p.x(), slab.lower.x(), slab.upper.x()), put(p.y(), slab.lower.y(), slab.upper.y()),
                          put(p.z(), slab.lower.z(), slab.upper.z()));
  }
}

bool is_sound(Mesh const& mesh) {
  return !mesh.is_empty() && mesh.is_valid(false) && CGAL::is_closed(mesh) && !PMP::does_self_intersect(mesh) &&
         PMP::does_bound_a_volume(mesh) && PMP::is_outward_oriented(mesh);
}

std::vector<Point> points_of(TriangleSurface const& surface) {
  std::vector<Point> points;
  for (Vec3 const& v : surface.vertices) points.emplace_back(v.x(), v.y(), v.z());
  return points;
}

std::vector<std::vector<std::size_t>> polygons_of(TriangleSurface const& surface) {
  std::vector<std::vector<std::size_t>> polygons;
  for (auto const& t : surface.triangles) polygons.push_back({t.begin(), t.end()});
  return polygons;
}

Mesh to_mesh(TriangleSurface const& surface) {
  Mesh mesh;
  PMP::polygon_soup_to_polygon_mesh(points_of(surface), polygons_of(surface), mesh);
  return mesh;
}

TriangleSurface to_surface(Mesh const& mesh) {
  TriangleSurface surface;
  for (auto v : mesh.vertices()) surface.vertices.emplace_back(mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z());
  for (auto f : mesh.faces()) {
    std::array<std::int32_t, 3> triangle{};
    std::size_t c = 0;
    for (auto v : mesh.vertices_around_face(mesh.halfedge(f))) triangle[c++] = static_cast<std::int32_t>(v);
    surface.triangles.push_back(triangle);
  }
  return surface;
}

/// An edge without exactly one opposite twin.
std::optional<std::array<std::size_t, 2>> find_open_edge(TriangleSurface const& surface) {
  std::map<std::array<std::size_t, 2>, int> uses;  // directed edges
  for (auto const& t : polygons_of(surface)) {
    for (std::size_t c = 0; c < 3; ++c) ++uses[{t[c], t[(c + 1) % 3]}];
  }
  for (auto const& [edge, count] : uses) {
    auto const twin = uses.find({edge[1], edge[0]});
    if (count != 1 || twin == uses.end() || twin->second != 1) return edge;
  }
  return std::nullopt;
}

/// Wraps whatever came out in a sound surface at most 0.05 cells away (Portaneri et al., ACM Trans. Graph. 41 (2022)
/// 127).
Mesh wrap(Mesh const& mesh) {
  Mesh wrapped;
  TriangleSurface const soup = to_surface(mesh);
  CGAL::alpha_wrap_3(points_of(soup), polygons_of(soup), 1.0, 0.05, wrapped);
  return wrapped;
}

Mesh sound_mesh(SurfaceLevel const& level, Slab const& slab) {
  for (double const threshold : {0.5, 0.497, 0.503, 0.494}) {  // moves the surface by a few thousandths of a cell
    try {
      Mesh mesh = refine(level, slab, threshold);
      snap_to_slab(mesh, slab);
      if (!mesh.is_empty() && CGAL::is_closed(mesh) && !PMP::is_outward_oriented(mesh))
        PMP::orient_to_bound_a_volume(mesh);
      if (is_sound(mesh)) return mesh;
      mesh = wrap(mesh);
      if (is_sound(mesh)) return mesh;
    } catch (CGAL::Failure_exception const&) {
      // degenerate at this threshold; the next one is not
    }
  }
  throw PhysicsError(
      "the solidified part has no closed surface free of self-intersection (its shape is finer than the cells) "
      "use smaller heat.cell_size");
}

struct Task {
  SurfaceLevel level;
  Slab slab;
};

Task meshing_task(SolidField const& solid, Case const& checked) {
  double const cell = solid.grid.cell;
  double const largest = largest_diameter(checked.powder);
  auto const margin = static_cast<std::int64_t>(std::ceil(0.5 * largest / cell)) + 1;
  auto const across = static_cast<double>(margin + rim);
  double const depth = std::max(std::ceil(checked.heat.substrate_depth / cell), crease_spacing);
  return {surface_level(solid, checked.material.density, ignored_voids(checked), margin),
          {Vec3(-static_cast<double>(pit_wall), -across, -depth),
           Vec3(static_cast<double>(solid.grid.n[0] + pit_wall), static_cast<double>(solid.grid.n[1]) + across, 0)}};
}

}  // namespace

TriangleSurface mesh_solid(SolidField const& solid, Case const& checked) {
  Task const task = meshing_task(solid, checked);
  TriangleSurface surface = to_surface(sound_mesh(task.level, task.slab));
  for (Vec3& v : surface.vertices) v = solid.grid.origin + solid.grid.cell * v;
  return surface;
}

double volume_to_mesh(SolidField const& solid, Case const& checked) {
  Task const task = meshing_task(solid, checked);
  return ((task.slab.upper - task.slab.lower).prod() + task.level.metal_cells) * solid.grid.cell_volume();
}

void check_substrate(TriangleSurface const& surface) {
  auto const at = [](Vec3 const& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p.x(), p.y(), p.z()); };
  auto const refuse = [](std::string const& what) { throw InputError("substrate mesh " + what); };
  if (auto const open = find_open_edge(surface)) {
    refuse(fmt::format(
        "has {} edges that do not join exactly two triangles of the same orientation (a hole, a fold or an inner "
        "wall), one near {}; close it",
        count_open_edges(surface), at(0.5 * (surface.vertices[open->at(0)] + surface.vertices[open->at(1)]))));
  }
  if (!PMP::is_polygon_soup_a_polygon_mesh(polygons_of(surface))) {
    refuse("has a corner at which several sheets touch (it is not manifold); separate them");
  }
  Mesh const mesh = to_mesh(surface);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> crossings;
  PMP::self_intersections(mesh, std::back_inserter(crossings));
  if (!crossings.empty()) {
    Point const& p = mesh.point(mesh.target(mesh.halfedge(crossings.front().first)));
    refuse(fmt::format("intersects itself in {} pairs of triangles, one near {}; unite its parts", crossings.size(),
                       at(Vec3(p.x(), p.y(), p.z()))));
  }
  if (!PMP::does_bound_a_volume(mesh) || !PMP::is_outward_oriented(mesh)) {
    refuse(fmt::format("is inside-out (it encloses {:.3g} m3); turn its triangles round", enclosed_volume(surface)));
  }
}

struct SurfaceDistance::Tree {
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
  using Aabb = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  Mesh mesh;
  Aabb aabb;
  CGAL::Side_of_triangle_mesh<Mesh, Kernel> side;

  explicit Tree(TriangleSurface const& surface)
      : mesh(to_mesh(surface)), aabb(faces(mesh).first, faces(mesh).second, mesh), side(aabb) {
    aabb.accelerate_distance_queries();
  }
};

SurfaceDistance::SurfaceDistance(TriangleSurface const& surface) : tree_(std::make_unique<Tree>(surface)) {}
SurfaceDistance::~SurfaceDistance() = default;

Vec3 SurfaceDistance::closest_point(Vec3 const& p) const {
  Point const q = tree_->aabb.closest_point(Point(p.x(), p.y(), p.z()));
  return {q.x(), q.y(), q.z()};
}

bool SurfaceDistance::encloses(Vec3 const& p) const {
  return tree_->side(Point(p.x(), p.y(), p.z())) != CGAL::ON_UNBOUNDED_SIDE;
}

}  // namespace layerloop::coupling
