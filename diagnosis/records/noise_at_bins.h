#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vibrissa::diagnosis {

/// Noise power at the bins 1 .. n_evaluated/2 - 1 of a part, relative to white noise of unit share,
/// for noise with these shares at the lines 0 .. n_samples/2 of the whole record. A line whose
/// period does not divide the part spreads over several bins:
///   bin(b) = sum_k share(k) sinc^2(d_k) / sum_k sinc^2(d_k),   d_k = k n_evaluated / n_samples -
///   b.
/// For a part that is the whole record (of even length) bins and lines are identical. Proven by
/// tests/diagnosis/records/noise_at_bins_test.cc.
std::vector<double> share_at_bins(std::span<const double> share_at_lines, std::size_t n_samples,
                                  std::size_t n_evaluated);

}  // namespace vibrissa::diagnosis
