#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "signals/excitation/multisine.h"

namespace vibrissa::signals {

/// Crest factor of one period of a sum of cosines sum_i amplitude_i cos(2 pi order_i t + phase_i),
/// with 16 times oversampling. Throws UserError for no line, order 0, an order given twice, or
/// lists of unequal length.
double crest_factor_of_period(const std::vector<std::size_t>& order,
                              const std::vector<double>& amplitude,
                              const std::vector<double>& phase_rad);

struct CrestOptions {
  std::size_t n_clippings = 500;       // first stage: number of clippings
  std::size_t n_descents = 300;        // second stage: iterations for each exponent
  std::size_t largest_exponent = 512;  // second stage: a power of 2
};

/// Phases that lower the crest factor at fixed amplitudes, from given initial phases. First the
/// peaks are clipped and the amplitudes of the spectrum are restored, repeatedly (van der Ouderaa,
/// Schoukens & Renneboog, IEEE Trans. Instrum. Meas. 37, 1988); then the norm sum_t x(t)^p is
/// minimised for p = 4, 8, 16 ... (Guillaume et al., IEEE Trans. Instrum. Meas. 40, 1991), here by
/// a quasi-Newton method whose gradient needs one Fourier transform. The result is never worse than
/// the initial phases; equal initial phases give equal results. Throws as crest_factor_of_period.
/// Proven by tests/signals/excitation/crest_factor_test.cc.
std::vector<double> lower_crest_factor(const std::vector<std::size_t>& order,
                                       const std::vector<double>& amplitude,
                                       std::vector<double> phase_rad,
                                       const CrestOptions& options = {});

}  // namespace vibrissa::signals
