#pragma once
#include <chrono>
#include <cstdint>
#include <utility>

namespace layerloop::dem {

/// Chooses between one thread and all that are allowed by timing both: where other programs keep the cores busy,
/// threads that wait for one another every step are slower than one. Results do not depend on the choice.
class ThreadTeam {
 public:
  void allow(int most) { most_ = most; }
  int most() const { return most_; }
  int threads() const { return many_ ? most_ : 1; }

  /// Runs `work`, which makes this many steps, and learns from how long it took.
  template <class Work>
  void time(std::int64_t steps, Work const& work) {
    if (most_ == 1) return work();
    auto const begin = std::chrono::steady_clock::now();
    work();
    if (std::exchange(has_just_changed_, false)) return;  // shares were made anew
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    steps_ += steps;
    if (seconds_ >= (settled_ ? between_trials : trial)) choose();
  }

 private:
  static constexpr double trial = 0.03, between_trials = 2;  // [s]

  /// After a trial of each the faster goes on, until the next trial of the other.
  void choose() {
    (many_ ? pace_of_all_ : pace_of_one_) = seconds_ / static_cast<double>(steps_);
    bool const other_is_known = !settled_ && (many_ ? pace_of_one_ : pace_of_all_) > 0;
    bool const all = other_is_known ? pace_of_all_ < pace_of_one_ : !many_;
    settled_ = other_is_known;
    has_just_changed_ = all != many_;
    many_ = all;
    if (settled_) (many_ ? pace_of_one_ : pace_of_all_) = 0;
    seconds_ = 0;
    steps_ = 0;
  }

  int most_ = 1;
  bool many_ = true, settled_ = false, has_just_changed_ = true;
  double seconds_ = 0, pace_of_one_ = 0, pace_of_all_ = 0;  // [s], [s a step]
  std::int64_t steps_ = 0;
};

}  // namespace layerloop::dem
