#pragma once

#include <string>

#include "separation/filters/normalised_lms.h"
#include "separation/filters/separator.h"

namespace vibrissa::separation {

struct LineCancellerOptions {
  /// Delay of the moment. It must be longer than the correlation time of the wind, so that only
  /// lines, whose correlation does not decay, can be predicted.
  std::size_t delay_samples = 50;
  NlmsOptions lms = {.filter_length = 200, .step = 0.02};
};

/// Removes the lines of a periodic vibration without any accelerometer: predicts the moment from
/// its own past, delay_samples ago, by normalised LMS, and returns the prediction error (Widrow et
/// al. 1975, the delay-based canceller of Routray et al. 2024, fig. 2a). Of a line of amplitude A
/// in white noise of variance s^2, the share s^2 / (s^2 + A^2 n_taps / 4) of the amplitude remains.
/// Steady wind and lines of the wind cannot be distinguished from vibration lines and are removed,
/// too. The base acceleration is not used. Proven by
/// tests/separation/filters/line_canceller_test.cc.
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
  TapWindow past_;  // the last delay_samples samples of the moment
  NormalisedLms lms_;
};

}  // namespace vibrissa::separation
