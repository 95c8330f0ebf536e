#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace vibrissa::separation {

/// All take two signals of equal, positive length and throw UserError otherwise, or when a value is
/// not finite. Ratios of powers are +infinity dB for a zero denominator and -infinity for a zero
/// numerator; 0 / 0 throws UserError. Proven by tests/separation/metrics/metrics_test.cc.

/// mean (x - estimate)^2, in the unit squared.
double mean_square_error(std::span<const double> truth, std::span<const double> estimate);

/// rms(truth - estimate) / rms(truth - mean truth). Throws UserError for a constant truth.
double nrmse(std::span<const double> truth, std::span<const double> estimate);

/// 100 (1 - nrmse): "accuracy %" of docs/theory.md (T15).
double fit_percent(std::span<const double> truth, std::span<const double> estimate);

/// Variance accounted for, 100 (1 - var(truth - estimate) / var(truth)); an offset does not change
/// it.
double vaf_percent(std::span<const double> truth, std::span<const double> estimate);

/// Signal-to-distortion ratio 10 log10(sum Ms^2 / sum (Ms - Ms_hat)^2) against the true wind
/// moment.
double sdr_db(std::span<const double> true_wind_moment, std::span<const double> wind_estimate);

/// The ratio that Routray et al. (2024) call SNR: 10 log10(power of the wind estimate / power of
/// the vibration estimate). It is not a measure of quality: a separator that removes nothing has a
/// high value.
double paper_snr_db(std::span<const double> wind_estimate,
                    std::span<const double> vibration_estimate);

struct Band {
  double low_hz = 0.;
  double high_hz = 0.;
};

/// Power of x in the band [unit^2], from one periodogram over the whole length without the mean; a
/// line on the edge is in the band. Throws UserError for a band without a line below half the
/// sampling rate.
double band_power(std::span<const double> x, double sampling_rate_hz, const Band& band);

/// 10 log10(band power of the estimate / band power of the truth).
double band_power_difference_db(std::span<const double> truth, std::span<const double> estimate,
                                double sampling_rate_hz, const Band& band);

/// Delay of y behind x in samples (negative: y leads): position of the maximum of the
/// cross-correlation, with the means removed, within ±max_delay, refined by a parabola through the
/// neighbouring values. Throws UserError for a constant signal or max_delay not below the length.
double delay_samples(std::span<const double> x, std::span<const double> y, std::size_t max_delay);

struct ConvergenceOptions {
  double window_s = 0.1;     // length for the short-term power
  double tolerance_db = 3.;  // distance to the final level
  double final_fraction =
      0.25;  // share of the record, at its end, whose mean power is the final level
};

/// First time after which the short-term power of the error never exceeds its final level by more
/// than the tolerance, from the first sample to the end of the first such window [s]. Nothing when
/// this time is in the final part.
std::optional<double> convergence_time_s(std::span<const double> error, double sampling_rate_hz,
                                         const ConvergenceOptions& options = {});

}  // namespace vibrissa::separation
