#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

namespace layerloop {

/// Progress of one long stage on stderr: a bar with time left on a terminal, else one line per 10 s. Root rank only.
class Progress {
 public:
  /// \param enabled  false on other ranks and with --quiet: then every call does nothing
  Progress(std::string stage, double total, bool enabled);
  ~Progress();
  void update(double done);

 private:
  void print(double done);

  std::string stage_;
  double total_;
  bool enabled_;
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

/// "12 s", "3 min 05 s", "2 h 10 min".
std::string as_time(double seconds);

/// Set by SIGINT, SIGTERM and SIGUSR1; long loops look at it collectively and stop at the next safe point.
bool stop_requested();
void catch_stop_signals();

}  // namespace layerloop
