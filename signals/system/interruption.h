#pragma once

namespace vibrissa::signals {

/// While one lives, Ctrl-C and a polite request to end (SIGINT, SIGTERM) are noted in place of
/// ending the program, so that long work can stop at a good place; the second time they end it as
/// usual. One at a time. Proven by tests/signals/system/interruption_test.cc.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  bool is_requested() const;
};

}  // namespace vibrissa::signals
