#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vibrissa::signals {

enum class MultisinePhase {
  schroeder,  // phi_i = -pi i (i - 1) / n_lines, phi_1 = 0 (docs/theory.md, T11)
  random,     // uniform, from the seed
  ascending,  // as in the experiment of the reference paper: phases in steps of 30 degrees, from
              // -90 degrees
  zero        // all phases -90 degrees: sines
};

/// A sum of cosines at lines of one period: sum_i amplitude_i cos(2 pi f_i t + phi_i).
struct Multisine {
  std::vector<double> frequency_hz;
  std::vector<double> amplitude;
  std::vector<double> phase_rad;

  /// Throws UserError when a frequency is not below half the sampling rate.
  std::vector<double> sample(double sampling_rate_hz, std::size_t n_samples) const;
};

/// Flat multisine at the given frequencies with the given peak of the *sum* (over one period with
/// 16 times oversampling: the true peak is less than 0.5 % higher). Throws UserError for no line, a
/// frequency that is not positive or given twice, frequencies without a common period, and a
/// negative peak. Proven by tests/signals/excitation/multisine_test.cc.
Multisine make_multisine(std::span<const double> frequency_hz, double peak_amplitude,
                         MultisinePhase phase, std::uint64_t seed = 0);

/// n_lines frequencies in [low, high] with logarithmic spacing, rounded to multiples of the
/// resolution 1/period, without repeats; a single line is in the logarithmic middle. Throws
/// UserError when they do not fit.
std::vector<double> multisine_lines(double low_hz, double high_hz, std::size_t n_lines,
                                    double resolution_hz);

/// Peak over root mean square. Throws UserError for a signal without power.
double crest_factor(std::span<const double> x);

}  // namespace vibrissa::signals
