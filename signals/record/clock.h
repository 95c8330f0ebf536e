#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "signals/record/time_axis.h"

namespace vibrissa::signals {

/// Rows of a file between which no sample is lost; the first row of the times has the number 0.
struct ClockPiece {
  std::size_t first = 0, count = 0;
  double start_s = 0.;
};

/// The clock of an evenly sampled device, from its stamps.
struct Clock {
  double sampling_rate_hz = 0.;
  double rate_error_hz = 0.;  // standard deviation; 0: the stamps are an exact grid
  double jitter_s = 0.;       // standard deviation of the stamps about the grid
  std::size_t n_lost = 0;
  double epoch_s = 0.;                  // that was subtracted from times since 1970
  bool is_from_bursts = false;          // the mean rate of bursts read from a buffer
  std::size_t packet = 1;               // samples that share one stamp, in nearly all packets
  std::vector<ClockPiece> pieces = {};  // in the order of the file; one where nothing is lost
  std::string words = {};  // "499.98 +- 0.01 Hz by regression over 1000 stamps, jitter 0.6 ms"
};

/// Recognises the clock: a uniform grid (find_time_axis), or by a regression over all stamps an
/// evenly sampled device whose stamps jitter, are shared by packets, come in bursts or wrap around
/// (2^16, 2^24, 2^32 counts, one minute, hour or day), and which lost samples; or intervals in
/// place of times. block_starts: rows (from 0) where a further recording begins. Throws UserError
/// with file and line for time that runs backward and for sampling that is not even. Proven by
/// tests/signals/record/clock_test.cc.
Clock find_clock(const PrintedTimes& times, const std::vector<std::size_t>& block_starts = {});

/// Throws UserError that names the first gap of a clock that has lost samples.
void refuse_lost_samples(const PrintedTimes& times, const Clock& clock);

}  // namespace vibrissa::signals
