#pragma once
#include <chrono>
#include <cstdint>

namespace layerloop::dem {

/// Chooses between one thread and all that are allowed by timing both now and then: where other programs keep the cores
/// busy, threads that wait for one another every step are slower than one. Results do not depend on the choice.
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
    if (steps_ >= (trial_ == Trial::none ? steps_between_trials : steps_a_trial)) next();
  }

 private:
  enum class Trial { many, one, none };
  static constexpr std::int64_t steps_a_trial = 200, steps_between_trials = 10000;

  void next() {
    double const pace = seconds_ / static_cast<double>(steps_);
    seconds_ = 0;
    steps_ = 0;
    if (trial_ == Trial::many) {
      pace_of_many_ = pace;
      many_ = false;
      trial_ = Trial::one;
    } else if (trial_ == Trial::one) {
      many_ = pace_of_many_ < pace;
      trial_ = Trial::none;
    } else {
      many_ = true;
      trial_ = Trial::many;
    }
  }

  int most_ = 1;
  bool many_ = true;
  Trial trial_ = Trial::many;
  double seconds_ = 0, pace_of_many_ = 0;
  std::int64_t steps_ = 0;
};

}  // namespace layerloop::dem
