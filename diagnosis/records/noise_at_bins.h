#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vibrissa::diagnosis {

/// Power at the bins 1 .. n_evaluated/2 - 1 of a part, in proportion to that of white noise of unit
/// share, of noise that has these shares at the lines 0 .. n_samples/2 of the whole record. A part
/// that is no multiple of a line's period sees the line at several of its bins:
///   bin(b) = sum_k share(k) sinc^2(d_k) / sum_k sinc^2(d_k),   d_k = k n_evaluated / n_samples -
///   b.
/// Of a part that is the whole record (of its even length) bin and line are one. Proven by
/// tests/diagnosis/records/noise_at_bins_test.cc.
std::vector<double> share_at_bins(std::span<const double> share_at_lines, std::size_t n_samples,
                                  std::size_t n_evaluated);

}  // namespace vibrissa::diagnosis
