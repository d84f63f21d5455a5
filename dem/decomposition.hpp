#pragma once
#include <cstdint>
#include <vector>

#include "core/communicator.hpp"
#include "dem/grains.hpp"

namespace layerloop::dem {

/// Grains shared out over the ranks in slices along x with equal loads, cut anew at every rebuild.
class Decomposition {
 public:
  /// \param period  along x; infinite: open [m]
  Decomposition(Communicator const& communicator, double period);

  /// Sends every grain, and the springs of its contacts, to the rank whose slice holds it. Collective.
  /// \param springs  in: those of this rank's grains; out: those of its new grains, sorted
  /// \param loads  work of each grain, in pairs
  void redistribute(std::vector<GrainRecord>& grains, std::vector<std::int64_t> const& loads,
                    std::vector<LocalSpring> const& old_springs, std::vector<ContactSpring>& springs);

  /// Appends copies of other ranks' grains that lie within `reach` of this rank's slice. Collective.
  void add_ghosts(Grains& grains, double reach);

  /// Brings position, velocity and spin of the ghosts up to date. Collective; allocates nothing.
  void update_ghosts(Grains& grains);

  /// Tells which ghosts are asleep. Collective.
  void update_ghost_sleep(Grains& grains) const;

  int size() const { return communicator_.size(); }
  int ranks_on_node() const { return ranks_on_node_; }  ///< that share this rank's cores

 private:
  /// Is x, or one of its images, in [low, high]?
  bool is_within(double x, double low, double high) const;

  Communicator communicator_;
  double period_;
  int ranks_on_node_ = 1;
  std::vector<double> cuts_;                          ///< slice r is [cuts_[r], cuts_[r + 1])
  std::vector<std::vector<std::int32_t>> sent_rows_;  ///< by rank
  std::vector<std::size_t> received_;                 ///< ghosts by rank
  std::vector<GrainState> send_buffer_, receive_buffer_;
  std::vector<MPI_Request> requests_;
};

}  // namespace layerloop::dem
