#pragma once
#include <cstdint>
#include <vector>

#include "dem/action_unit.hpp"
#include "dem/contact_law.hpp"
#include "dem/neighbours.hpp"
#include "dem/user_attraction.hpp"

namespace layerloop::dem {

/// Laws for each pair of materials: law(a, b) is at [a * materials + b].
struct LawTable {
  LawForm form;
  std::int32_t materials = 1;
  std::vector<ContactLaw> laws;
  std::vector<UserAttraction> user = {};  ///< effects of loaded libraries that are on
};

/// The pairs of some rows that may touch before the grains have moved on by `half_gap` each, with their springs: only
/// these are computed. Pairs of sleeping grains are left out too.
///
/// In chunks of rows, each in two parts that are filled up to whole vectors by pairs with the row behind the last
/// grain, which is far away: pairs whose higher row moves soon, and the others (across a seam of the order, a period,
/// or into another share). What a pair does is added up in a ring of slots, row modulo `ring`, small enough for the
/// cache; what the others do to their higher row waits in a slot of its own behind the ring.
struct NearPairs {
  using Numbers = std::vector<double, HugePages<double>>;
  using Rows = std::vector<std::int32_t, HugePages<std::int32_t>>;
  std::size_t from = 0, to = 0;  ///< rows: pairs whose lower row is one of these
  Rows first, second;
  Numbers spring_x, spring_y, spring_z;
  Numbers turn_x, turn_y, turn_z;      ///< only with a rolling spring
  std::vector<std::uint8_t> touching;  ///< at the last evaluation
  std::vector<PairSpring> dormant;     ///< springs of pairs that are left out
  std::vector<std::size_t> chunk;      ///< begin of each chunk's pairs; chunks + 1 values
  std::vector<std::size_t> far_part;   ///< of each chunk: begin of its second part
  std::vector<std::size_t> far_slots;  ///< of each chunk: begin of its second part in `slot_first`, `slot_second`
  std::vector<std::int32_t> slot_first, slot_second;
  std::vector<std::int32_t> far_rows;  ///< owned rows with a slot behind the ring, ascending: far_slot + place

  static constexpr std::size_t rows_a_chunk = 256, ring = 2048;
  static constexpr std::int32_t nowhere = ring, far_slot = ring + 1;  ///< `nowhere`: what is done to ghosts
  std::size_t chunks() const { return far_part.size(); }
  std::size_t slots() const { return ring + 1 + far_rows.size(); }
  /// One more than the highest owned row in a pair.
  std::size_t reach() const { return far_rows.empty() ? 0 : static_cast<std::size_t>(far_rows.back()) + 1; }
};

/// The near pairs of the rows of `old`, chosen anew; their springs are those of `old`, near or dormant.
/// \param gap  surfaces closer than this are near [m]
NearPairs choose_near(NearPairs const& old, Neighbours& neighbours, Grains const& grains, Period const& period,
                      double gap, bool has_turn);

/// Puts the springs of all shares' pairs back among the dormant ones of the list.
void make_dormant(Neighbours& neighbours, std::vector<NearPairs const*> const& shares);

/// Springs of all touching pairs of the rows of `near`.
void append_springs(NearPairs const& near, Neighbours const& neighbours, Grains const& grains,
                    std::vector<LocalSpring>& springs);

/// Touching pairs of the rows of `near` whose first row is below `owned`.
std::int64_t count_touching(NearPairs const& near, Neighbours const& neighbours, std::size_t owned);

/// Adds what the pairs of one chunk do to their grains. No allocation.
/// \param actions  slots() of them, of this thread
/// \return largest overlap over the smaller grain's diameter
double evaluate_pairs(NearPairs& near, std::size_t chunk, Grains const& grains, LawTable const& laws,
                      Period const& period, double dt, ActionUnit const& unit, GrainAction* actions);

}  // namespace layerloop::dem
