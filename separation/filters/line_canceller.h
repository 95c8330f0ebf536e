#pragma once

#include <string>

#include "separation/filters/normalised_lms.h"
#include "separation/filters/separator.h"

namespace vibrissa::separation {

struct LineCancellerOptions {
  /// Of the moment against itself. Longer than the wind's correlation, so that only lines, which
  /// correlate for ever, can be predicted.
  std::size_t delay_samples = 50;
  NlmsOptions lms = {.filter_length = 200, .step = 0.02};
};

/// Removes the lines of a periodic vibration without any accelerometer: predicts the moment from
/// its own past, delay_samples ago, by normalised LMS, and hands on what could not be predicted
/// (Widrow et al. 1975, the delay-based canceller of Routray et al. 2024, fig. 2a). A line of
/// amplitude A in white noise of variance s^2 remains with s^2 / (s^2 + A^2 n_taps / 4) of its
/// amplitude. Steady wind and wind lines look like vibration lines and are removed, too.
/// Ignores the base acceleration. Proven by tests/separation/filters/line_canceller_test.cc.
class LineCanceller : public Separator {
 public:
  /// Throws UserError for options out of range, with the option's name.
  explicit LineCanceller(const LineCancellerOptions& options);

  void process(std::span<const double> base_acceleration, std::span<const double> base_moment,
               std::span<double> wind_moment) override;
  void reset() override;
  std::string name() const override { return "line canceller"; }
  std::size_t latency_samples() const override { return 0; }

 private:
  TapWindow past_;  // the last delay_samples moments
  NormalisedLms lms_;
};

}  // namespace vibrissa::separation
