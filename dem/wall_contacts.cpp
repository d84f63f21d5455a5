#include "dem/wall_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dem/law_lanes.hpp"

namespace layerloop::dem {
namespace {

/// A grain, as walls see it.
struct GrainView {
  Vec3 centre, v, w;
  double radius, inverse_mass;
};

GrainView view_of(Grains const& grains, std::size_t i) {
  GrainState const& g = grains[i];
  return {{g.x, g.y, g.z}, {g.vx, g.vy, g.vz}, {g.wx, g.wy, g.wz}, g.radius, g.inverse_mass};
}

WallPose const& pose_of(WallCandidate const& candidate, WallScene const& scene) {
  return scene.moving.poses()[static_cast<std::size_t>(candidate.wall)];
}

Vec3 in_frame_of(WallPose const& pose, Vec3 const& p) { return {p.x() - pose.dx, p.y(), p.z() - pose.dz}; }

bool is_triangle(std::int64_t key) { return key >= first_triangle_key; }

bool same_mesh(std::int64_t a, std::int64_t b) {
  return is_triangle(a) && is_triangle(b) &&
         (a - first_triangle_key) / keys_a_mesh == (b - first_triangle_key) / keys_a_mesh;
}

std::int32_t triangle_of(std::int64_t key) {
  return static_cast<std::int32_t>((key - first_triangle_key) % keys_a_mesh);
}

bool share_corner(TriangleSurface const& surface, std::int32_t a, std::int32_t b) {
  auto const &first = surface.triangles[static_cast<std::size_t>(a)],
             &second = surface.triangles[static_cast<std::size_t>(b)];
  return std::ranges::find_first_of(first, second) != first.end();
}

WallSpring new_spring(std::int64_t key) { return {.key = key, .x = 0, .y = 0, .z = 0, .is_old = false}; }

WallSpring own_spring(WallContacts const& contacts, std::size_t w, std::int64_t key) {
  auto const begin = contacts.springs.begin() + contacts.spring_begin[w], end = begin + contacts.spring_count[w];
  auto const own = std::find_if(begin, end, [&](WallSpring const& s) { return s.key == key; });
  return own != end ? *own : new_spring(key);
}

/// The spring that a contact with a triangle goes on with: its own, or, where a grain rolls from one triangle to the
/// next, that of a neighbouring triangle which it has just left.
WallSpring inherited(WallContacts const& contacts, std::size_t w, std::int64_t key,
                     std::vector<TriangleContact> const& touched, TriangleSurface const& surface) {
  auto const begin = contacts.springs.begin() + contacts.spring_begin[w], end = begin + contacts.spring_count[w];
  if (std::any_of(begin, end, [&](WallSpring const& s) { return s.key == key; })) return own_spring(contacts, w, key);
  WallSpring const* left = nullptr;
  auto const was_left_for_this = [&](WallSpring const& s) {
    if (!same_mesh(s.key, key)) return false;
    return share_corner(surface, triangle_of(s.key), triangle_of(key)) &&
           std::ranges::none_of(touched, [&](TriangleContact const& t) { return t.triangle == triangle_of(s.key); });
  };
  for (auto s = begin; s != end; ++s) {
    if (was_left_for_this(*s) && (!left || s->key < left->key)) left = &*s;
  }
  if (!left) return new_spring(key);
  WallSpring taken = *left;
  taken.key = key;
  return taken;
}

void append(WallBatch& b, GrainView const& g, double distance, Vec3 const& n, std::size_t wall, WallScene const& scene,
            double friction, WallSpring const& spring, std::size_t material) {
  if (b.size == b.octets.size() * lanes_at_once) b.octets.emplace_back();
  WallOctet& octet = b.octets[b.size / lanes_at_once];
  std::size_t const l = b.size++ % lanes_at_once;
  BasicContactState<Numbers>& s = octet.state;
  double const overlap = g.radius - distance, arm = g.radius - 0.5 * std::max(overlap, 0.0);
  WallSurface const surface = surface_of(scene, wall, n);
  s.overlap[l] = overlap;
  s.radius[l] = g.radius;
  s.inverse_mass[l] = g.inverse_mass;
  s.nx[l] = n.x(), s.ny[l] = n.y(), s.nz[l] = n.z();
  s.vx[l] = g.v.x() - surface.vx, s.vy[l] = g.v.y(), s.vz[l] = g.v.z() - surface.vz;
  s.sx[l] = arm * g.w.x(), s.sy[l] = arm * g.w.y(), s.sz[l] = arm * g.w.z();
  s.wx[l] = g.w.x(), s.wy[l] = g.w.y() - surface.spin, s.wz[l] = g.w.z();
  s.spring_x[l] = spring.x, s.spring_y[l] = spring.y, s.spring_z[l] = spring.z;
  s.turn_x[l] = spring.turn_x, s.turn_y[l] = spring.turn_y, s.turn_z[l] = spring.turn_z;
  double const close = g.radius * g.radius / distance;  // the image of a charge in a plane lies as deep behind it
  s.closeness[l] = scene.form.reach == Reach::beyond ? close * close : 0.0;
  s.was_touching[l] = spring.is_old ? -1 : 0;
  octet.friction[l] = scene.walls.friction(wall).value_or(friction);
  octet.law[l] = static_cast<std::int64_t>(material);
  octet.key[l] = spring.key;
  octet.wall[l] = static_cast<std::int32_t>(wall);
}

/// Eight contacts at once; lanes without a contact compute what nobody reads.
template <Reach reach, RollingModel rolling, bool many_laws>
void act_on(WallBatch& b, ContactLaw const* laws, double dt) {
  BasicContactLaw<Numbers> law = filled_law(laws[0]);
  for (std::size_t c = 0; c < b.size; c += lanes_at_once) {
    WallOctet& octet = b.octets[c / lanes_at_once];
    if constexpr (many_laws) law = gathered_law(laws, octet.law);
    law.sliding_friction = octet.friction;
    octet.action = act<reach, rolling>(law, octet.state, dt);
  }
}

template <Reach reach, bool many_laws>
void act_on(WallBatch& b, ContactLaw const* laws, RollingModel rolling, double dt) {
  if (rolling == RollingModel::cdt)
    act_on<reach, RollingModel::cdt, many_laws>(b, laws, dt);
  else
    act_on<reach, RollingModel::epsd2, many_laws>(b, laws, dt);
}

template <bool many_laws>
void act_on(WallBatch& b, ContactLaw const* laws, LawForm const& form, double dt) {
  switch (form.reach) {
    case Reach::touch:
      return act_on<Reach::touch, many_laws>(b, laws, form.rolling, dt);
    case Reach::tear_off:
      return act_on<Reach::tear_off, many_laws>(b, laws, form.rolling, dt);
    case Reach::beyond:
      return act_on<Reach::beyond, many_laws>(b, laws, form.rolling, dt);
  }
}

/// Walls and triangles within `reach` of a grain.
void find_candidates(WallScene const& scene, MeshGrids const& grids, GrainView const& g, double skin,
                     std::vector<std::int32_t>& triangles, std::vector<WallCandidate>& found) {
  Walls const& walls = scene.walls;
  double const reach = g.radius + skin;
  for (std::size_t wall = 0; wall < walls.size(); ++wall) {
    WallCandidate candidate{key_of(walls, wall), static_cast<std::int32_t>(wall), 0};
    if (wall < walls.primitives()) {
      if (distance_to(candidate, scene, g.centre) < reach) found.push_back(candidate);
      continue;
    }
    std::int64_t const first = candidate.key;
    grids[wall - walls.primitives()].find(in_frame_of(pose_of(candidate, scene), g.centre), reach, triangles);
    for (std::int32_t const t : triangles) {
      candidate.key = first + t;
      if (distance_to(candidate, scene, g.centre) < reach) found.push_back(candidate);
    }
  }
}

/// Contacts of one grain with the triangles [from, to) of one mesh, merged. Triangles out of reach are put to sleep
/// for as long as they cannot be reached.
void touch_mesh(WallContacts& contacts, std::size_t w, WallBatch& batch, GrainView const& g, WallScene const& scene,
                double friction, std::size_t material, std::size_t from, std::size_t to) {
  auto const wall = static_cast<std::size_t>(contacts.candidates[from].wall);
  WallPose const& pose = scene.moving.poses()[wall];
  TriangleSurface const& surface = scene.walls.surface(wall);
  double const path = contacts.path[w] + pose.path;
  Vec3 const centre = in_frame_of(pose, g.centre);
  batch.touched.clear();
  for (std::size_t c = from; c < to; ++c) {
    WallCandidate& candidate = contacts.candidates[c];
    if (candidate.awake_at > path) continue;
    TriangleContact const contact = contact_with(surface, candidate.triangle(), centre);
    double const gap = std::abs(contact.distance) - g.radius - scene.reach_gap;
    if (gap < 0)
      batch.touched.push_back(contact);
    else
      candidate.awake_at = path + gap * (1 - 1e-9);
  }
  if (batch.touched.empty()) return;
  merge_contacts(surface, batch.touched);
  std::int64_t const first = contacts.candidates[from].key - contacts.candidates[from].triangle();
  for (TriangleContact const& t : batch.touched)
    append(batch, g, t.distance, t.normal, wall, scene, friction,
           inherited(contacts, w, first + t.triangle, batch.touched, surface), material);
}

void touch_primitive(WallContacts& contacts, std::size_t w, WallBatch& batch, GrainView const& g,
                     WallScene const& scene, double friction, std::size_t material, WallCandidate& candidate) {
  auto const wall = static_cast<std::size_t>(candidate.wall);
  WallPose const& pose = scene.moving.poses()[wall];
  double const path = contacts.path[w] + pose.path;
  if (candidate.awake_at > path) return;
  WallPoint const near = nearest(scene.walls, wall, scene.width, in_frame_of(pose, g.centre));
  double const gap = near.distance - g.radius - scene.reach_gap;
  if (gap < 0)
    append(batch, g, near.distance, {near.nx, near.ny, near.nz}, wall, scene, friction,
           own_spring(contacts, w, candidate.key), material);
  else
    candidate.awake_at = path + gap * (1 - 1e-9);
}

/// Adds force and torque of the contacts of one grain, from `at` on in the batch, and keeps their springs.
double take_over(WallContacts& c, std::size_t w, WallBatch& batch, WallScene const& scene, double radius,
                 std::size_t& at) {
  double worst = 0;
  ForceQuad force{}, torque{};
  WallSpring* kept = &c.springs[static_cast<std::size_t>(c.spring_begin[w])];
  std::int32_t const contacts = std::exchange(c.spring_count[w], 0);
  for (std::int32_t s = 0; s < contacts; ++s, ++at) {
    WallOctet const& octet = batch.octet(at);
    BasicContactAction<Numbers> const& a = octet.action;
    std::size_t const l = at % lanes_at_once;
    if (a.touches[l])
      kept[c.spring_count[w]++] = {octet.key[l], a.spring_x[l], a.spring_y[l], a.spring_z[l],
                                   a.turn_x[l],  a.turn_y[l],   a.turn_z[l]};
    double const overlap = octet.state.overlap[l], arm = radius - 0.5 * std::max(overlap, 0.0);
    force[0] += a.fx[l], force[1] += a.fy[l], force[2] += a.fz[l];
    torque[0] -= arm * a.qx[l] + a.rx[l], torque[1] -= arm * a.qy[l] + a.ry[l], torque[2] -= arm * a.qz[l] + a.rz[l];
    worst = std::max(worst, overlap);
    auto const wall = static_cast<std::size_t>(octet.wall[l]);
    if (!scene.moving.moves(wall)) continue;
    batch.force[wall][0] -= std::llround(a.fx[l] / wall_force_unit);
    batch.force[wall][1] -= std::llround(a.fz[l] / wall_force_unit);
  }
  c.force[w] = force;
  c.torque[w] = torque;
  return worst / (2 * radius);
}

}  // namespace

WallSurface surface_of(WallScene const& scene, std::size_t wall, Vec3 const& normal) {
  WallPose const& pose = scene.moving.poses()[wall];
  std::size_t const roller = wall - scene.walls.blocks.size();
  if (roller >= scene.walls.rollers.size()) return {pose.vx, pose.vz, 0};
  Roller const& r = scene.walls.rollers[roller];
  double const speed = r.spin * r.radius;  // spin x normal, with spin along y
  return {pose.vx + speed * normal.z(), pose.vz - speed * normal.x(), r.spin};
}

double distance_to(WallCandidate const& candidate, WallScene const& scene, Vec3 const& centre) {
  auto const wall = static_cast<std::size_t>(candidate.wall);
  Vec3 const p = in_frame_of(pose_of(candidate, scene), centre);
  if (!is_triangle(candidate.key)) return nearest(scene.walls, wall, scene.width, p).distance;
  return std::abs(contact_with(scene.walls.surface(wall), candidate.triangle(), p).distance);
}

MeshGrids grids_of(Walls const& walls, double cell) {
  MeshGrids grids;
  for (std::size_t wall = walls.primitives(); wall < walls.size(); ++wall)
    grids.emplace_back(walls.surface(wall), cell);
  return grids;
}

ContactState WallBatch::state(std::size_t contact) const {
  BasicContactState<Numbers> const& s = octet(contact).state;
  std::size_t const l = contact % lanes_at_once;
  return {s.overlap[l],
          s.radius[l],
          s.inverse_mass[l],
          s.nx[l],
          s.ny[l],
          s.nz[l],
          s.vx[l],
          s.vy[l],
          s.vz[l],
          s.sx[l],
          s.sy[l],
          s.sz[l],
          s.wx[l],
          s.wy[l],
          s.wz[l],
          s.spring_x[l],
          s.spring_y[l],
          s.spring_z[l],
          s.turn_x[l],
          s.turn_y[l],
          s.turn_z[l],
          s.closeness[l],
          s.was_touching[l] != 0};
}

void build_wall_contacts(WallContacts& contacts, Grains const& g, WallScene const& scene, MeshGrids const& grids,
                         double skin, std::vector<ContactSpring> const& springs) {
  WallContacts& c = contacts;
  for (auto* list : {&c.grain, &c.spring_count}) list->clear();
  c.candidates.clear();
  c.springs.clear();
  for (auto* begin : {&c.begin, &c.spring_begin}) begin->assign(1, 0);
  std::vector<std::int32_t> triangles;
  for (std::size_t i = 0; i < g.owned; ++i) {
    std::size_t const before = c.candidates.size();
    find_candidates(scene, grids, view_of(g, i), skin, triangles, c.candidates);
    if (c.candidates.size() == before) continue;
    c.grain.push_back(static_cast<std::int32_t>(i));
    c.begin.push_back(static_cast<std::int32_t>(c.candidates.size()));

    // wall keys are >= 0, so key_b <= -1: the springs of this grain lie before (id, 0)
    auto old = std::ranges::lower_bound(springs, g.id[i], {}, &ContactSpring::key_a);
    std::int32_t count = 0;
    for (; old != springs.end() && old->key_a == g.id[i] && old->key_b < 0; ++old, ++count)
      c.springs.push_back({wall_key_of(old->key_b), old->spring[0], old->spring[1], old->spring[2], old->turn[0],
                           old->turn[1], old->turn[2]});
    c.spring_count.push_back(count);
    std::size_t const room = std::max(c.candidates.size() - before, static_cast<std::size_t>(count));
    c.springs.resize(static_cast<std::size_t>(c.spring_begin.back()) + room);
    c.spring_begin.push_back(static_cast<std::int32_t>(c.springs.size()));
  }
  c.path.assign(c.grain.size(), 0.0);
  c.force.assign(c.grain.size(), {});
  c.torque.assign(c.grain.size(), {});
}

void append_springs(WallContacts const& c, Grains const& g, std::vector<LocalSpring>& springs) {
  for (std::size_t w = 0; w < c.grain.size(); ++w) {
    for (std::int32_t s = 0; s < c.spring_count[w]; ++s) {
      WallSpring const& spring = c.springs[static_cast<std::size_t>(c.spring_begin[w] + s)];
      springs.push_back({{g.id[static_cast<std::size_t>(c.grain[w])],
                          -1 - spring.key,
                          {spring.x, spring.y, spring.z},
                          {spring.turn_x, spring.turn_y, spring.turn_z}},
                         c.grain[w],
                         -1});
    }
  }
}

bool is_near_moving_wall(WallContacts const& c, std::size_t w, MovingWalls const& moving) {
  auto const begin = c.candidates.begin();
  return std::any_of(begin + c.begin[w], begin + c.begin[w + 1], [&](WallCandidate const& candidate) {
    return moving.moves(static_cast<std::size_t>(candidate.wall));
  });
}

void list_wall_contacts(WallContacts& contacts, WallBatch& batch, Grains const& g, WallScene const& scene,
                        std::vector<ContactLaw> const& laws, std::size_t from, std::size_t to) {
  if (from == to) return;
  WallContacts& c = contacts;
  bool const many = laws.size() > 1;
  batch.size = 0;
  for (std::size_t w = from; w < to; ++w) {
    auto const row = static_cast<std::size_t>(c.grain[w]);
    if (is_asleep(g.quiet[row])) continue;
    GrainView const grain = view_of(g, row);
    auto const material = many ? static_cast<std::size_t>(g.material[row]) : 0;
    double const friction = laws[material].sliding_friction;
    auto const already = batch.size;
    auto const end = static_cast<std::size_t>(c.begin[w + 1]);
    for (auto k = static_cast<std::size_t>(c.begin[w]); k < end;) {
      if (!is_triangle(c.candidates[k].key)) {
        touch_primitive(c, w, batch, grain, scene, friction, material, c.candidates[k++]);
        continue;
      }
      std::size_t last = k;
      while (last < end && c.candidates[last].wall == c.candidates[k].wall) ++last;
      touch_mesh(c, w, batch, grain, scene, friction, material, k, last);
      k = last;
    }
    c.spring_count[w] = static_cast<std::int32_t>(batch.size - already);
  }
}

double act_on_walls(WallContacts& contacts, WallBatch& batch, Grains const& g, WallScene const& scene,
                    std::vector<ContactLaw> const& laws, double dt, std::size_t from, std::size_t to) {
  if (from == to) return 0;
  if (laws.size() > 1)
    act_on<true>(batch, laws.data(), scene.form, dt);
  else
    act_on<false>(batch, laws.data(), scene.form, dt);
  batch.force.resize(scene.walls.size());
  double worst = 0;
  std::size_t at = 0;
  for (std::size_t w = from; w < to; ++w) {
    auto const row = static_cast<std::size_t>(contacts.grain[w]);
    if (is_asleep(g.quiet[row])) continue;
    worst = std::max(worst, take_over(contacts, w, batch, scene, g[row].radius, at));
  }
  return worst;
}

}  // namespace layerloop::dem
