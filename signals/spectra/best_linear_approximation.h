#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "signals/spectra/frequency_response.h"
#include "signals/spectra/line_grid.h"
#include "signals/spectra/period_average.h"

namespace vibrissa::signals {

/// Best linear approximation of a weakly nonlinear system, with noise separated from distortion
/// (Pintelon & Schoukens, System Identification, 2nd ed., chapter 4). E|error|^2 throughout.
struct RobustApproximation {
  FrequencyResponse response;          // its deviation: noise and distortion of the mean together
  std::vector<double> noise_variance;  // share of noise in the variance of the mean
  /// Variance of the distortion that one realisation adds to its response (stochastic nonlinear
  /// contribution). The estimate is unbiased, so it is negative at some lines of a linear system.
  std::vector<double> distortion_variance;
  std::size_t n_realisations = 0, n_periods = 0;
};

/// Robust method: the mean response of several realisations with random phases. The scatter between
/// realisations contains noise and distortion, the scatter between periods only noise. The two
/// deviations of a mean of n realisations have 2 (n - 1) degrees of freedom. lines: the orders to
/// use, by default those that every realisation excites. A single period gives NaN for noise and
/// distortion. Throws UserError for fewer than two realisations, realisations with different
/// periods or rates, no common line, or a line without input. Proven by
/// tests/signals/spectra/best_linear_approximation_test.cc.
RobustApproximation robust_approximation(std::span<const PeriodAverage> realisations,
                                         std::vector<std::size_t> lines = {});

/// The output at a line that the input does not excite, without the share that the input causes
/// there.
struct DetectedOutput {
  std::size_t order = 0;
  double frequency_hz = 0.;
  LineRole role = LineRole::even_detection;
  double power = 0.;        // |amplitude|^2, noise and distortion
  double noise_power = 0.;  // share of noise, from the scatter between periods
};

/// Powers are squared amplitudes of the mean output over the periods, interpolated from the
/// detection lines to the excited lines. The powers of the distortion contain no noise and may be
/// negative.
struct FastApproximation {
  FrequencyResponse response;          // its deviation: noise and odd distortion together
  std::vector<double> noise_variance;  // share of noise in it
  std::vector<double> noise_power, even_power, odd_power;  // at the excited lines
  std::vector<DetectedOutput> detection;
};

struct FastOptions {
  std::vector<std::size_t> excited = {};  // orders; by default those above the threshold
  double excitation_threshold = 1e-4;     // share of the largest input power
  std::size_t n_averaged = 4;  // number of detection lines whose mean is the level at a line
};

/// Fast method: one realisation on a random-odd grid, at least two periods. The even and odd
/// detection lines show even and odd distortion above their noise; the level at an excited line is
/// the mean of the nearest n_averaged lines of each role. Without odd detection lines odd_power is
/// empty and the deviation contains only noise. Throws UserError for a single period, an even line
/// that is excited, or fewer detection lines than are averaged. Proven by
/// tests/signals/spectra/best_linear_approximation_test.cc.
FastApproximation fast_approximation(const PeriodAverage& average, const FastOptions& options = {});

}  // namespace vibrissa::signals
