#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "separation/ringdown/decay_curve.h"
#include "separation/ringdown/decay_pieces.h"

namespace vibrissa::separation {

/// A mode from its free decays.
struct RingDown {
  Decays decays;
  FittedDecay fit;
  /// Damped sines of a few periods each, one after the other: without any law.
  std::vector<DecayPoint> measured;
  /// Of the largest decay by the fitted law, from the largest to the smallest amplitude.
  std::vector<DecayPoint> fitted;
  std::vector<Envelope> envelopes;        // of each fitted decay, at the record's times and moments
  EquivalentMode largest, smallest;       // shares of the damping at both ends
  std::vector<std::string> damping_laws;  // of "viscous", "drag", "friction": 5 % or more
  double error_rms_n_m = 0.;              // that the law leaves
  /// By how much the damping of the measured points differs from the law's, in their standard
  /// deviations (rms); 5 % are allowed for.
  double deviation_of_rows = 0.;
  std::string unit = "N m";  // of the amplitudes: that of the samples
  std::string words;

  /// Does the law leave much more than the noise of the quietest part, or differ from the points?
  bool is_doubtful() const;
};

/// Frequency and damping of the strongest mode against amplitude, from a base moment [N m] that
/// decays after hits or releases, and the law of its damping: viscous, drag (in proportion to the
/// square of the speed), dry friction, with a cubic spring. A part enters the law where it lowers
/// Schwarz's criterion (BIC, 1978) by 10 or more. Of a long record 12 000 samples of the decays are
/// fitted. Throws UserError as find_decays(), and where no mode explains half of the moment. Proven
/// by tests/separation/ringdown/ring_down_test.cc: twenty oscillators that another method
/// integrates.
RingDown identify_ring_down(std::span<const double> moment, double sampling_rate_hz,
                            const std::string& unit = "N m");

/// The answer in sentences.
std::string words_of(const RingDown& found);

/// {"words", "unit", "doubtful", "error_rms", "noise_rms", "deviation_of_rows", "damping_laws",
/// "law": {"frequency_hz", "damping_ratio", "cubic", "drag", "slip", "stick_ratio"}, "pieces",
/// "measured", "fitted": [{"amplitude", "frequency_hz", "frequency_sd_hz", "damping_ratio",
/// "damping_sd"}]}. "unit" is that of amplitude, error_rms, noise_rms and slip; drag is per unit,
/// cubic per its square.
nlohmann::json ring_down_json(const RingDown& found);

}  // namespace vibrissa::separation
