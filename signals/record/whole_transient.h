#pragma once

#include "signals/record/record.h"

namespace vibrissa::signals {

/// Does a record begin and end at rest, so that it holds the whole response to its base motion (an
/// earthquake, a hit)? In the first and the last fiftieth of the record the moment has less than
/// 2 % of its rms, and the acceleration, which may begin before it is felt, less than 10 %. Then
/// its discrete Fourier transform is that of the whole motion, without leakage (Bendat and Piersol,
/// Random Data, 4th ed., 2010, 11.6). Proven by tests/signals/record/whole_transient_test.cc.
bool is_whole_transient(const Record& record);

}  // namespace vibrissa::signals
