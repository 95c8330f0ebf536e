#pragma once

#include <span>

namespace vibrissa::signals {

/// Even samples on the clock of their device.
struct ClockedSignal {
  std::span<const double> values;
  double sampling_rate_hz = 0., start_s = 0.;
};

/// What two devices record of one motion: the same quantity, or a quantity and the response of a
/// sensor to it, whose phase is not known.
enum class SharedMotion { quantity, response };

/// Time of the first device = offset + (1 + drift) * time of the other one, with standard
/// deviations; that of the offset is at the other's first sample.
struct ClockRelation {
  double offset_s = 0., drift = 0.;
  double offset_deviation_s = 0., drift_deviation = 0.;
  bool is_opposite = false;  // one rises where the other falls

  double first_time_s(double other_time_s) const { return offset_s + (1. + drift) * other_time_s; }
  double other_time_s(double first_time_s) const {
    return (first_time_s - offset_s) / (1. + drift);
  }
};

/// The relation of two clocks from a motion that both devices recorded. Coarse: whitened windows of
/// one are found in the other by correlation (shared_motion.h). Fine: phase of the cross-spectrum
/// over frequency, block by block (Piersol, IEEE Trans. ASSP 29, 1981); lines weigh by the inverse
/// variance of their phase (1 - g2) / (2 n g2), g2 the coherence. Of a response the phase at each
/// frequency is free: the drift is that of the phases between blocks, and the offset keeps the
/// sensor's delay. Throws UserError where the offset is not determined: no motion in common, or one
/// that repeats. Proven by tests/signals/spectra/clock_relation_test.cc.
ClockRelation relate_clocks(const ClockedSignal& first, const ClockedSignal& other,
                            SharedMotion shared);

}  // namespace vibrissa::signals
