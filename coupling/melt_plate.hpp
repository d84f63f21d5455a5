#pragma once
#include "core/case.hpp"
#include "core/heat_source.hpp"
#include "core/melt_record.hpp"

namespace layerloop::coupling {

/// What the verb melt expects before it computes.
struct PoolEstimate {
  double absorptivity = 0;
  PoolSize pool;
};

/// The track of the most power: what estimates are made for. \pre the case's scan is a good one
Track strongest_track(Case const& checked);

/// A steady pool of constant properties (thermal/eagar_tsai.hpp) under what a flat surface absorbs; with the effect
/// keyhole at least as deep as Gan et al. (Nat. Commun. 12 (2021) 2379) find, e = 0.4 (Ke - 1.4) spot radii, for an
/// absorptivity of 0.8.
PoolEstimate estimate_pool(Case const& checked);

/// The case with cell size and plate chosen where it leaves them open, and sizes rounded up to whole cells: cells of a
/// twelfth of the spot, at most a sixth of the estimated depth, at least a fortieth of the spot; a plate three pools
/// wide and four deep around the tracks. The far field lies as far beyond the sides as the tracks from them. A case
/// with a machine of its own stays as it is.
Case with_plate(Case checked, PoolEstimate const& estimate);

/// The same with other cells on a plate of the same size.
Case with_cells(Case checked, double cell);

/// Normalised enthalpy A P / (rho h_s sqrt(pi a v w^3)), w the 1/e2 radius of the beam, h_s the enthalpy at melting, a
/// the diffusivity at the solidus. Source: King et al., J. Mater. Process. Technol. 214 (2014) 2915, who take another
/// radius.
double normalised_enthalpy(Case const& checked, double absorptivity);

}  // namespace layerloop::coupling
