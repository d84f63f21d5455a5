#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dem/contact_law.hpp"
#include "dem/grains.hpp"

namespace layerloop::dem {

/// What one contact does to its two grains: force on the first, torque on either.
struct alignas(32) PairAction {
  std::array<double, 4> force, torque_first, torque_second;
};

/// Pairs of grains closer than the skin, with their springs. The first grain of a pair has the lower id, so that a pair
/// is computed the same way on every rank that holds it.
struct PairContacts {
  std::vector<std::int32_t> first, second;  ///< rows
  std::vector<double> radius_sum, reduced_radius, reduced_mass;
  std::vector<double> inverse_diameter;              ///< of the smaller grain
  std::vector<double> spring_x, spring_y, spring_z;  ///< valid while `touching`
  std::vector<std::int32_t> touching;                ///< at the last evaluation: -1 yes, 0 no
  std::vector<std::int32_t> action;                  ///< row in `actions`; 0 (nothing) when not touching
  std::vector<PairAction> actions;

  /// Pairs of every owned grain in order of the partner's id: 2 * pair + (1 when the grain is the second).
  std::vector<std::int32_t> begin, entries;

  std::size_t size() const { return first.size(); }
};

/// Lists all pairs with an owned grain whose surfaces are closer than `skin`; y wraps with `period`. Springs are taken
/// over.
void build_pairs(PairContacts& pairs, Grains const& grains, double skin, double period,
                 std::vector<ContactSpring> const& springs);

void append_springs(PairContacts const& pairs, Grains const& grains, std::vector<LocalSpring>& springs);

/// Forces of the pairs [from, to). No allocation.
/// \return largest overlap over the smaller grain's diameter
double evaluate_pairs(PairContacts& pairs, Grains const& grains, ContactLaw const& law, double period, double dt,
                      std::size_t from, std::size_t to);

/// Adds what all contacts do to one owned grain: the same order on any number of ranks.
inline void add_pair_actions(PairContacts const& pairs, std::size_t row, double* force, double* torque) {
  for (std::int32_t e = pairs.begin[row]; e < pairs.begin[row + 1]; ++e) {
    std::int32_t const entry = pairs.entries[static_cast<std::size_t>(e)];
    PairAction const& action =
        pairs.actions[static_cast<std::size_t>(pairs.action[static_cast<std::size_t>(entry >> 1)])];
    bool const second = entry & 1;
    double const sign = second ? -1.0 : 1.0;
    double const* turn = second ? action.torque_second.data() : action.torque_first.data();
    for (std::size_t c = 0; c < 4; ++c) force[c] += sign * action.force[c];
    for (std::size_t c = 0; c < 4; ++c) torque[c] += turn[c];
  }
}

}  // namespace layerloop::dem
