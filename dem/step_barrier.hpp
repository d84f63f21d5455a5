#pragma once
#include <sched.h>

#include <atomic>

namespace layerloop::dem {

/// Barrier for threads that meet every few tens of microseconds: spins for about a step, then hands its core to whoever
/// needs it. An OpenMP barrier spins for milliseconds first, which is the end of all speed where more threads than
/// cores are busy.
class StepBarrier {
 public:
  /// \param threads  that meet here: the same for all of them
  void wait(int threads) {
    if (threads == 1) return;
    unsigned const round = round_.load(std::memory_order_acquire);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == threads) {
      arrived_.store(0, std::memory_order_relaxed);
      round_.store(round + 1, std::memory_order_release);
      return;
    }
    for (int spin = 0; round_.load(std::memory_order_acquire) == round; ++spin) {
      if (spin > 50000) sched_yield();  // some tens of microseconds: longer than threads that run ever wait
    }
  }

 private:
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<unsigned> round_{0};
};

}  // namespace layerloop::dem
