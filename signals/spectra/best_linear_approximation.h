#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "signals/spectra/frequency_response.h"
#include "signals/spectra/line_grid.h"
#include "signals/spectra/period_average.h"

namespace vibrissa::signals {

/// Best linear approximation of a system that distorts a little, with noise told from distortion
/// (Pintelon & Schoukens, System Identification, 2nd ed., section 4.3). E|error|^2 throughout.
struct RobustApproximation {
  FrequencyResponse response;  // its deviation is that of the mean: noise and distortion together
  std::vector<double> noise_variance;  // share of noise in the variance of the mean
  /// Of the distortion that a single realisation adds to its response (stochastic nonlinear
  /// contribution). Unbiased, hence below zero at some lines of a linear system.
  std::vector<double> distortion_variance;
  std::size_t n_realisations = 0, n_periods = 0;
};

/// Robust method: responses of several realisations with random phases, averaged. Their scatter
/// holds noise and distortion, that between periods noise alone. The two deviations of a mean of n
/// realisations have 2 (n - 1) degrees of freedom. Lines: the orders used, by default those that
/// every realisation excites. A single period gives NaN for noise and distortion. Throws UserError
/// for less than two realisations, realisations of unequal period or rate, no common line, or a
/// line without input. Proven by tests/signals/spectra/best_linear_approximation_test.cc.
RobustApproximation robust_approximation(std::span<const PeriodAverage> realisations,
                                         std::vector<std::size_t> lines = {});

/// The output at a line that the input does not excite, what leaks in by the input taken off.
struct DetectedOutput {
  std::size_t order = 0;
  double frequency_hz = 0.;
  LineRole role = LineRole::even_detection;
  double power = 0.;        // |amplitude|^2, noise and distortion
  double noise_power = 0.;  // share of noise, from the scatter between periods
};

/// Powers are squared amplitudes of the output's mean over the periods, interpolated from the
/// detection lines to the excited ones: distortion has no noise in it and may be below zero.
struct FastApproximation {
  FrequencyResponse response;          // its deviation: noise and odd distortion together
  std::vector<double> noise_variance;  // share of noise in it
  std::vector<double> noise_power, even_power, odd_power;  // at the excited lines
  std::vector<DetectedOutput> detection;
};

struct FastOptions {
  std::vector<std::size_t> excited = {};  // orders; by default those above the threshold
  double excitation_threshold = 1e-4;     // of the largest input power
  std::size_t n_averaged = 4;             // detection lines whose mean is the level at a line
};

/// Fast method: one realisation on a random-odd grid, two periods at least. Even and odd distortion
/// are what the even and odd lines left out show above their noise; about an excited line it is
/// the mean of the nearest n_averaged lines of each role. Without odd detection lines odd_power is
/// empty and the deviation is that of noise alone. Throws UserError for a single period, an even
/// line that is excited, or fewer detection lines than are averaged.
/// Proven by tests/signals/spectra/best_linear_approximation_test.cc.
FastApproximation fast_approximation(const PeriodAverage& average, const FastOptions& options = {});

}  // namespace vibrissa::signals
