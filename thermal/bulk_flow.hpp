#pragma once
#include "thermal/conduction.hpp"

namespace layerloop::thermal {

/// Heat that bulk faces bring into a cell [W/m], from Theta of the cells around [W/m]. Each of `lateral` (along x and
/// y), `below`, `vertical` and `above` (along z) gives it for a local cell of its plane. The six flows are added in
/// pairs, in one order for every cell: results depend neither on the ranks nor, mirrored, on the side.
struct BulkFlow {
  float const *share_x, *share_y, *share_z;
  std::int64_t sy, sz;

  explicit BulkFlow(Conduction const& conduction)
      : share_x(conduction.share_x.data()),
        share_y(conduction.share_y.data()),
        share_z(conduction.share_z.data()),
        sy(conduction.box.stride_y()),
        sz(conduction.box.stride_z()) {}

  template <class Lateral, class Below, class Vertical, class Above>
  double operator()(std::int64_t c, Lateral const& lateral, Below const& below, Vertical const& vertical,
                    Above const& above) const {
    double const t = lateral(c), v = vertical(c);
    double const along_x = share_x[c - 1] * (lateral(c - 1) - t) + share_x[c] * (lateral(c + 1) - t);
    double const along_y = share_y[c - sy] * (lateral(c - sy) - t) + share_y[c] * (lateral(c + sy) - t);
    double const along_z = share_z[c - sz] * (below(c - sz) - v) + share_z[c] * (above(c + sz) - v);
    return along_x + along_y + along_z;
  }
};

}  // namespace layerloop::thermal
