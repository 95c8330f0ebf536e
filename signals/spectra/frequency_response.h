#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace vibrissa::signals {

/// Non-parametric frequency response output/input (convention exp(+j w t): the phase of a delay
/// decreases with frequency), with coherence and deviation.
struct FrequencyResponse {
  std::vector<double> frequency_hz;
  std::vector<std::complex<double>> value;  // output unit / input unit
  std::vector<double> coherence;            // 0 .. 1
  std::vector<double> standard_deviation;   // of |value|'s complex error, E|error|^2 = sd^2
};

/// Response from whole periods of a periodic record in steady state: spectra averaged over periods
/// (no leakage), only at the excited lines (input power at least excitation_threshold times its
/// maximum). Zero frequency and half the sampling rate are never used. Standard deviation and
/// coherence from the scatter between periods (two periods needed; one period gives NaN). Throws
/// UserError when the record contains less than one period or no line is excited.
FrequencyResponse periodic_response(std::span<const double> input, std::span<const double> output,
                                    double sampling_rate_hz, std::size_t period_samples,
                                    double excitation_threshold = 1e-4);

struct WelchOptions {
  std::size_t segment_samples = 2048;  // Hann window, half overlapped
};

/// H1 estimate of an arbitrary record by Welch's method, with coherence and its standard deviation
/// |H| sqrt((1 - g2) / (g2 n_averages)), n_averages the equivalent number of segments without
/// overlap (Welch 1967). Zero frequency and half the sampling rate are excluded; NaN where the
/// input has no power. Throws UserError when fewer than two segments fit or the input is constant.
FrequencyResponse welch_response(std::span<const double> input, std::span<const double> output,
                                 double sampling_rate_hz, const WelchOptions& options = {});

/// n_averages of welch_response for records of this length: the coherence of unrelated noise is 1 /
/// n_averages. Throws UserError when no segment fits.
double welch_averages(std::size_t n_samples, const WelchOptions& options = {});

/// One-sided power spectral density by Welch's method [unit^2/Hz], mean removed per segment: its
/// sum times the line spacing is the variance. Throws UserError when no segment fits.
struct PowerSpectrum {
  std::vector<double> frequency_hz;
  std::vector<double> density;
};
PowerSpectrum welch_spectrum(std::span<const double> x, double sampling_rate_hz,
                             const WelchOptions& options = {});

}  // namespace vibrissa::signals
