#pragma once

#include <utility>

#include "signals/record/record.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation::test {

/// A record of base acceleration and base moment.
inline signals::Record make_record(Signal acceleration, Signal moment, double rate = rate_hz) {
  signals::Record record(rate, acceleration.size());
  record.set_channel(signals::channel::base_acceleration, std::move(acceleration));
  record.set_channel(signals::channel::base_moment, std::move(moment));
  return record;
}

}  // namespace vibrissa::separation::test
