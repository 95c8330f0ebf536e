#pragma once

#include <cstddef>
#include <numbers>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// Index of the frequency block of a bin. A block is a tenth of the first mode's frequency wide, so
/// that the chain's response hardly changes within it.
inline std::size_t frequency_block(const Experiment& experiment, const PreparedRecord& record,
                                   std::size_t bin) {
  const double block_hz = 0.1 * experiment.scales.first_mode_rad_s / (2. * std::numbers::pi);
  return static_cast<std::size_t>(static_cast<double>(bin + 1) * record.bin_hz() / block_hz);
}

}  // namespace vibrissa::diagnosis
