#include "dem/wall_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace layerloop::dem {
namespace {

Vec3 centre(Grains const& g, std::size_t i) { return {g[i].x, g[i].y, g[i].z}; }

/// The triangles that grain `w` overlaps now, merged; the others are put to sleep for as long as they cannot be
/// reached.
void find_touched(WallContacts& contacts, std::size_t w, Grains const& g, TriangleSurface const& surface,
                  std::vector<TriangleContact>& touched) {
  touched.clear();
  auto const i = static_cast<std::size_t>(contacts.grain[w]);
  for (std::int32_t c = contacts.triangle_begin[w]; c < contacts.triangle_begin[w + 1]; ++c) {
    TriangleCandidate& candidate = contacts.triangles[static_cast<std::size_t>(c)];
    if (candidate.awake_at > contacts.path[w]) continue;
    TriangleContact const contact = contact_with(surface, candidate.triangle, centre(g, i));
    double const gap = std::abs(contact.distance) - g[i].radius;
    if (gap < 0)
      touched.push_back(contact);
    else
      candidate.awake_at = contacts.path[w] + gap * (1 - 1e-9);
  }
  merge_contacts(surface, touched);
}

bool share_corner(TriangleSurface const& surface, std::int64_t a, std::int64_t b) {
  auto const &first = surface.triangles[static_cast<std::size_t>(a)],
             &second = surface.triangles[static_cast<std::size_t>(b)];
  return std::ranges::find_first_of(first, second) != first.end();
}

/// The spring that a contact goes on with: its own, or, where a grain rolls from one triangle to the next, that of a
/// neighbouring triangle which it has just left.
WallSpring inherited(WallContacts const& contacts, std::size_t w, std::int64_t key,
                     std::vector<TriangleContact> const& touched, TriangleSurface const& surface) {
  auto const begin = contacts.springs.begin() + contacts.spring_begin[w], end = begin + contacts.spring_count[w];
  auto const own = std::find_if(begin, end, [&](WallSpring const& s) { return s.key == key; });
  if (own != end) return *own;
  WallSpring const* left = nullptr;
  auto const was_left_for_this = [&](WallSpring const& s) {
    if (s.key < first_triangle_key) return false;
    std::int64_t const triangle = s.key - first_triangle_key;
    return share_corner(surface, triangle, key - first_triangle_key) &&
           std::ranges::none_of(touched, [&](TriangleContact const& t) { return t.triangle == triangle; });
  };
  for (auto s = begin; s != end && key >= first_triangle_key; ++s) {
    if (was_left_for_this(*s) && (!left || s->key < left->key)) left = &*s;
  }
  if (left) return {key, left->x, left->y, left->z};
  return {key, 0, 0, 0};
}

void append(WallBatch& b, Grains const& g, std::size_t i, double distance, Vec3 const& n, double wall_velocity,
            WallSpring const& spring) {
  double const overlap = g[i].radius - distance, arm = g[i].radius - 0.5 * overlap;
  b.overlap.push_back(overlap);
  b.radius.push_back(g[i].radius);
  b.inverse_mass.push_back(g[i].inverse_mass);
  b.nx.push_back(n.x());
  b.ny.push_back(n.y());
  b.nz.push_back(n.z());
  b.vx.push_back(g[i].vx - wall_velocity);
  b.vy.push_back(g[i].vy);
  b.vz.push_back(g[i].vz);
  b.sx.push_back(arm * g[i].wx);
  b.sy.push_back(arm * g[i].wy);
  b.sz.push_back(arm * g[i].wz);
  b.wx.push_back(g[i].wx);
  b.wy.push_back(g[i].wy);
  b.wz.push_back(g[i].wz);
  b.spring_x.push_back(spring.x);
  b.spring_y.push_back(spring.y);
  b.spring_z.push_back(spring.z);
  b.key.push_back(spring.key);
}

void clear(WallBatch& b) {
  for (auto* v : {&b.overlap, &b.radius, &b.inverse_mass, &b.nx, &b.ny, &b.nz, &b.vx, &b.vy, &b.vz, &b.sx, &b.sy, &b.sz,
                  &b.wx, &b.wy, &b.wz, &b.spring_x, &b.spring_y, &b.spring_z})
    v->clear();
  b.key.clear();
}

/// All contacts of the batch at once.
void act_on(WallBatch& b, ContactLaw const& law, double dt) {
  std::size_t const n = b.overlap.size();
  for (auto* v : {&b.fx, &b.fy, &b.fz, &b.tx, &b.ty, &b.tz}) v->resize(n);
  double const *overlap = b.overlap.data(), *radius = b.radius.data(), *inverse_mass = b.inverse_mass.data();
  double const *nx = b.nx.data(), *ny = b.ny.data(), *nz = b.nz.data();
  double const *vx = b.vx.data(), *vy = b.vy.data(), *vz = b.vz.data();
  double const *sx = b.sx.data(), *sy = b.sy.data(), *sz = b.sz.data();
  double const *wx = b.wx.data(), *wy = b.wy.data(), *wz = b.wz.data();
  double *ux = b.spring_x.data(), *uy = b.spring_y.data(), *uz = b.spring_z.data();
  double *fx = b.fx.data(), *fy = b.fy.data(), *fz = b.fz.data(), *tx = b.tx.data(), *ty = b.ty.data(),
         *tz = b.tz.data();
  ContactLaw const law_here = law;
#pragma omp simd
  for (std::size_t c = 0; c < n; ++c) {
    double const arm = radius[c] - 0.5 * overlap[c];
    ContactAction const a = act<Reach::touch, RollingModel::cdt>(
        law_here,
        {overlap[c], radius[c], inverse_mass[c], nx[c], ny[c], nz[c], vx[c], vy[c], vz[c], sx[c], sy[c], sz[c],
         wx[c],      wy[c],     wz[c],           ux[c], uy[c], uz[c], 0,     0,     0,     0,     false},
        dt);
    ux[c] = a.spring_x;
    uy[c] = a.spring_y;
    uz[c] = a.spring_z;
    fx[c] = a.fx;
    fy[c] = a.fy;
    fz[c] = a.fz;
    tx[c] = -arm * a.qx - a.rx;
    ty[c] = -arm * a.qy - a.ry;
    tz[c] = -arm * a.qz - a.rz;
  }
}

std::vector<std::int32_t> blocks_near(Walls const& walls, Grains const& g, std::size_t i, double skin, double time) {
  std::vector<std::int32_t> near;
  for (std::size_t b = 0; b < walls.blocks.size(); ++b) {
    RoundedBlock const& block = walls.blocks[b];
    if (nearest(block, block.velocity * time, g[i].x, g[i].z).distance < g[i].radius + skin)
      near.push_back(static_cast<std::int32_t>(b));
  }
  return near;
}

}  // namespace

void WallBatch::reserve(std::size_t contacts) {
  for (auto* v : {&overlap, &radius, &inverse_mass, &nx,       &ny,       &nz,       &vx, &vy, &vz, &sx, &sy, &sz,
                  &wx,      &wy,     &wz,           &spring_x, &spring_y, &spring_z, &fx, &fy, &fz, &tx, &ty, &tz})
    v->reserve(contacts);
  key.reserve(contacts);
  touched.reserve(256);
}

void build_wall_contacts(WallContacts& contacts, Grains const& g, Walls const& walls, TriangleGrid const& grid,
                         double skin, double time, std::vector<ContactSpring> const& springs) {
  WallContacts& c = contacts;
  for (auto* list : {&c.grain, &c.blocks, &c.spring_count}) list->clear();
  c.triangles.clear();
  c.springs.clear();
  for (auto* begin : {&c.block_begin, &c.triangle_begin, &c.spring_begin}) begin->assign(1, 0);
  std::vector<std::int32_t> triangles;
  for (std::size_t i = 0; i < g.owned; ++i) {
    std::vector<std::int32_t> const blocks = blocks_near(walls, g, i, skin, time);
    double const reach = g[i].radius + skin;
    grid.find(centre(g, i), reach, triangles);
    std::erase_if(triangles, [&](std::int32_t t) {
      return std::abs(contact_with(walls.substrate, t, centre(g, i)).distance) >= reach;
    });
    if (blocks.empty() && triangles.empty()) continue;
    c.grain.push_back(static_cast<std::int32_t>(i));
    c.blocks.insert(c.blocks.end(), blocks.begin(), blocks.end());
    for (std::int32_t const t : triangles) c.triangles.push_back({t, 0});
    c.block_begin.push_back(static_cast<std::int32_t>(c.blocks.size()));
    c.triangle_begin.push_back(static_cast<std::int32_t>(c.triangles.size()));

    // wall keys are >= 0, so key_b <= -1: the springs of this grain lie before (id, 0)
    auto old = std::ranges::lower_bound(springs, g.id[i], {}, &ContactSpring::key_a);
    std::int32_t count = 0;
    for (; old != springs.end() && old->key_a == g.id[i] && old->key_b < 0; ++old, ++count)
      c.springs.push_back({wall_key_of(old->key_b), old->spring[0], old->spring[1], old->spring[2]});
    c.spring_count.push_back(count);
    std::size_t const room = std::max(blocks.size() + triangles.size(), static_cast<std::size_t>(count));
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
      springs.push_back({{g.id[static_cast<std::size_t>(c.grain[w])], -1 - spring.key, {spring.x, spring.y, spring.z}},
                         c.grain[w],
                         -1});
    }
  }
}

bool is_near_moving_wall(WallContacts const& c, std::size_t w, Walls const& walls) {
  auto const begin = c.blocks.begin();
  return std::any_of(begin + c.block_begin[w], begin + c.block_begin[w + 1],
                     [&](std::int32_t block) { return walls.blocks[static_cast<std::size_t>(block)].velocity != 0; });
}

WallReport evaluate_walls(WallContacts& contacts, WallBatch& batch, Grains const& g, Walls const& walls,
                          ContactLaw const& law, double time, double dt, std::size_t from, std::size_t to) {
  WallContacts& c = contacts;
  WallReport report;
  clear(batch);
  for (std::size_t w = from; w < to; ++w) {
    auto const i = static_cast<std::size_t>(c.grain[w]);
    auto const already = batch.key.size();
    find_touched(c, w, g, walls.substrate, batch.touched);
    for (std::int32_t b = c.block_begin[w]; b < c.block_begin[w + 1]; ++b) {
      std::int32_t const key = c.blocks[static_cast<std::size_t>(b)];
      RoundedBlock const& block = walls.blocks[static_cast<std::size_t>(key)];
      WallPoint const near = nearest(block, block.velocity * time, g[i].x, g[i].z);
      if (near.distance < g[i].radius)
        append(batch, g, i, near.distance, {near.nx, 0, near.nz}, block.velocity,
               inherited(c, w, key, batch.touched, walls.substrate));
    }
    for (TriangleContact const& t : batch.touched)
      append(batch, g, i, t.distance, t.normal, 0,
             inherited(c, w, first_triangle_key + t.triangle, batch.touched, walls.substrate));
    c.spring_count[w] = static_cast<std::int32_t>(batch.key.size() - already);
  }
  act_on(batch, law, dt);
  std::size_t at = 0;
  for (std::size_t w = from; w < to; ++w) {
    c.force[w] = c.torque[w] = {};
    double const diameter = 2 * g[static_cast<std::size_t>(c.grain[w])].radius;
    for (std::int32_t s = 0; s < c.spring_count[w]; ++s, ++at) {
      c.springs[static_cast<std::size_t>(c.spring_begin[w] + s)] = {batch.key[at], batch.spring_x[at],
                                                                    batch.spring_y[at], batch.spring_z[at]};
      double const force[3] = {batch.fx[at], batch.fy[at], batch.fz[at]},
                   torque[3] = {batch.tx[at], batch.ty[at], batch.tz[at]};
      for (std::size_t d = 0; d < 3; ++d) c.force[w][d] += force[d], c.torque[w][d] += torque[d];
      bool const moves =
          batch.key[at] < first_triangle_key && walls.blocks[static_cast<std::size_t>(batch.key[at])].velocity != 0;
      report.worst_overlap = std::max(report.worst_overlap, batch.overlap[at] / diameter);
      if (moves) report.pushed_back -= std::llround(batch.fx[at] * 1e18);
    }
  }
  return report;
}

}  // namespace layerloop::dem
