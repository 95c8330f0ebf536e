#pragma once

namespace vibrissa::signals {

/// During its lifetime, the first SIGINT (Ctrl-C) or SIGTERM sets a flag and does not end the
/// program, so that long work can stop at a suitable point; the second one ends the program. Only
/// one object may exist at a time. Proven by tests/signals/system/interruption_test.cc.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  bool is_requested() const;
};

}  // namespace vibrissa::signals
