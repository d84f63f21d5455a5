#pragma once
#include <chrono>
#include <cstdint>

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
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    steps_ += steps;
    if (steps_ >= until_) choose();
  }

 private:
  static constexpr std::int64_t trial = 300;      // steps; threads that have not paid then stop
  static constexpr std::int64_t with_one = 8000;  // steps of one thread before all get another try

  void choose() {
    double const pace = seconds_ / static_cast<double>(steps_);
    if (!many_) pace_of_one_ = pace;
    many_ = !many_ || pace < pace_of_one_;
    until_ = many_ ? trial : with_one;
    seconds_ = 0;
    steps_ = 0;
  }

  int most_ = 1;
  bool many_ = false;
  double seconds_ = 0, pace_of_one_ = 0;
  std::int64_t steps_ = 0, until_ = trial;
};

}  // namespace layerloop::dem
