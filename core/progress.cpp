#include "core/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

namespace layerloop {
namespace {
volatile std::sig_atomic_t stop_flag = 0;
extern "C" void on_stop_signal(int) { stop_flag = 1; }
}  // namespace

std::string as_time(double seconds) {
  auto const s = static_cast<std::int64_t>(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

Progress::Progress(std::string stage, double total, bool enabled)
    : stage_(std::move(stage)),
      total_(total),
      enabled_(enabled),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (enabled_ && drawn_ && terminal_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::update(double done) {
  if (!enabled_) return;
  auto const now = std::chrono::steady_clock::now();
  if (now - last_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(10000))) return;
  last_ = now;
  print(done);
}

void Progress::print(double done) {
  drawn_ = true;
  double const share = std::clamp(total_ > 0 ? done / total_ : 1.0, 0.0, 1.0);
  double const elapsed = std::chrono::duration<double>(last_ - start_).count();
  std::string const left = share > 0.005 ? as_time(elapsed * (1 - share) / share) + " left" : "";
  if (terminal_) {
    auto const filled = static_cast<std::size_t>(share * 30);
    fmt::print(stderr, "\r\x1b[K  {:<24} [{}{}] {:3.0f} %  {}", stage_, std::string(filled, '#'),
               std::string(30 - filled, '.'), 100 * share, left);
  } else {
    fmt::print(stderr, "  {}: {:.0f} %, {}\n", stage_, 100 * share, left);
  }
}

bool stop_requested() { return stop_flag != 0; }

void catch_stop_signals() {
  for (int const signal : {SIGINT, SIGTERM, SIGUSR1}) std::signal(signal, on_stop_signal);
}

}  // namespace layerloop
