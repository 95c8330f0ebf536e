#pragma once

#include <span>
#include <vector>

#include "signals/spectra/frequency_response.h"

namespace vibrissa::signals {

/// Fewest lines of a response whose noise its neighbours tell.
inline constexpr std::size_t fewest_response_lines = 12;

/// Standard deviation of each line of a response, E|error|^2 = sd^2, from its neighbours: what a
/// parabola over a straight line through nine lines leaves, which can follow a resonance (local
/// rational method, McKelvey and Guerin 2012, IFAC Proc. 45(16), 424-429; Pintelon and Schoukens
/// 2012, ch. 7), as the median over 21 lines, so that a jump of the response is no noise. Throws
/// UserError for fewer than fewest_response_lines lines. Proven by
/// tests/signals/spectra/response_noise_test.cc.
std::vector<double> deviation_from_neighbours(const FrequencyResponse& response);

/// The same from the coherence g2 and the number of averages, |H| sqrt((1 - g2) / (g2 n)) (Bendat
/// and Piersol 2010, ch. 9).
std::vector<double> deviation_from_coherence(const FrequencyResponse& response, double n_averages);

/// The same from responses that were measured in the same way at the same frequencies, two or more.
std::vector<double> deviation_from_repeats(std::span<const FrequencyResponse* const> repeats);

}  // namespace vibrissa::signals
