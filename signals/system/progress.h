#pragma once

#include <cstddef>
#include <string>

#include "signals/system/stopwatch.h"

namespace vibrissa::signals {

/// Progress bar with the remaining time on standard error; draws only when standard error is a
/// terminal and show is true. Redraws at most ten times a second. Proven by
/// tests/signals/system/progress_test.cc.
class Progress {
 public:
  Progress(std::string title, std::size_t n_steps, bool show = true);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void advance(std::size_t n = 1);

 private:
  void draw(bool last);
  std::string title_;
  std::size_t n_steps_, done_ = 0;
  bool show_;
  Stopwatch since_start_, since_drawn_;
};

}  // namespace vibrissa::signals
