#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace vibrissa::signals {

/// Mean spectra of two noisy periodic channels, with the covariance of their noise, as a fit with
/// errors in both variables needs them (Pintelon & Schoukens, System Identification, 2nd ed.,
/// chapter 2). Entry i belongs to line i + 1 of the period; zero frequency and half the sampling
/// rate are excluded. Spectra are amplitudes: a cos(w t + p) has a exp(j p).
struct PeriodAverage {
  double sampling_rate_hz = 0.;
  std::size_t period_samples = 0;
  std::size_t n_periods = 0;
  std::vector<std::complex<double>> input, output;  // means over the periods
  // Variances of the errors e of these means, from the scatter between periods (NaN for a single
  // period):
  std::vector<double> input_variance, output_variance;  // E|e_u|^2, E|e_y|^2
  std::vector<std::complex<double>> covariance;         // E e_y conj(e_u)

  std::size_t n_lines() const { return input.size(); }
  double frequency_hz(std::size_t order) const {
    return static_cast<double>(order) * sampling_rate_hz / static_cast<double>(period_samples);
  }
  /// Output over input at a line, and E|error|^2 of it to first order in the noise:
  /// (E|e_y|^2 + |G|^2 E|e_u|^2 - 2 Re(conj(G) E e_y conj(e_u))) / |U|^2. Order from 1.
  std::complex<double> response(std::size_t order) const;
  double response_variance(std::size_t order) const;
  /// E|e_y - G e_u|^2 for a given G: the noise of both channels, expressed at the output.
  double residual_variance(std::size_t order, std::complex<double> response) const;
};

/// Average over the last whole periods of a record in steady state. Throws UserError for channels
/// of unequal length, samples that are not finite, a rate that is not positive, a period below 4
/// samples and less than one period. Proven by tests/signals/spectra/period_average_test.cc.
PeriodAverage average_periods(std::span<const double> input, std::span<const double> output,
                              double sampling_rate_hz, std::size_t period_samples);

/// Orders of the lines whose input power is at least the threshold times the largest. Throws
/// UserError when the input is zero or the threshold is not in (0, 1].
std::vector<std::size_t> excited_orders(const PeriodAverage& average, double threshold = 1e-4);

}  // namespace vibrissa::signals
