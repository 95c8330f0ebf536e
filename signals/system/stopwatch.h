#pragma once

#include <chrono>
#include <functional>
#include <utility>

namespace vibrissa::signals {

/// Elapsed time since the start or restart. A backward step of the clock counts as no time: the
/// steady clock of a virtual machine can step back when the machine moves to another host. Proven
/// by tests/signals/system/stopwatch_test.cc.
class Stopwatch {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Stopwatch(std::function<Clock::time_point()> now = Clock::now)
      : now_(std::move(now)), last_(now_()) {}

  double elapsed_s() {
    const Clock::time_point now = now_();
    if (now > last_) elapsed_ += now - last_;
    last_ = now;
    return std::chrono::duration<double>(elapsed_).count();
  }
  void restart() {
    elapsed_s();
    elapsed_ = {};
  }

 private:
  std::function<Clock::time_point()> now_;
  Clock::time_point last_;
  Clock::duration elapsed_{};
};

}  // namespace vibrissa::signals
