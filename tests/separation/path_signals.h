#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "separation/filters/spectra_buffer.h"
#include "signals/spectra/fft.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation::test {

/// First-order autoregression of white noise with deviation one; 0: white.
inline Signal coloured_noise(std::size_t n, double memory, std::uint64_t seed) {
  Signal x = white_noise(n, 1., seed);
  for (std::size_t i = 1; i < n; ++i) x[i] += memory * x[i - 1];
  return x;
}

/// Taps of random sign that decay by exp(-1) every decay_samples.
inline Signal decaying_taps(std::size_t n, double decay_samples, std::uint64_t seed) {
  Signal taps = white_noise(n, 1., seed);
  for (std::size_t i = 0; i < n; ++i) taps[i] *= std::exp(-static_cast<double>(i) / decay_samples);
  return taps;
}

/// Rests before the first sample.
inline Signal convolve(const Signal& taps, const Signal& x) {
  Signal y(x.size(), 0.);
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t tap = 0; tap < taps.size() && tap <= i; ++tap) y[i] += taps[tap] * x[i - tap];
  return y;
}

/// Cross-correlation of a block of errors with the input: what a filter's adapt() adds to its taps.
inline Signal correlation(const Signal& x, const Signal& e, std::size_t block_start,
                          std::size_t n_taps) {
  Signal taps(n_taps, 0.);
  for (std::size_t tap = 0; tap < n_taps; ++tap)
    for (std::size_t i = 0; i < e.size(); ++i)
      if (block_start + i >= tap) taps[tap] += e[i] * x[block_start + i - tap];
  return taps;
}

/// Of the error of a block in the second half of its transform, the first half zero.
inline Spectrum error_spectrum(const Signal& e) {
  signals::RealFft fft(2 * e.size());
  std::ranges::copy(e, fft.time().last(e.size()).begin());
  fft.forward();
  return Eigen::Map<const Spectrum>(fft.spectrum().data(), static_cast<Eigen::Index>(fft.n_bins()));
}

/// The FIR filter with least sum of squares of d - taps * x, x at rest before its first sample, by
/// the normal equations; weight of sample i: forgetting^(n - 1 - i).
inline Signal least_squares_taps(const Signal& x, const Signal& d, std::size_t n_taps,
                                 double forgetting = 1., double ridge = 0.) {
  const auto n = static_cast<Eigen::Index>(x.size()), m = static_cast<Eigen::Index>(n_taps);
  Eigen::MatrixXd lagged = Eigen::MatrixXd::Zero(m, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double weight = std::pow(forgetting, 0.5 * static_cast<double>(n - 1 - i));
    for (Eigen::Index k = 0; k <= i && k < m; ++k)
      lagged(k, i) = weight * x[static_cast<std::size_t>(i - k)];
  }
  Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(d.data(), n);
  for (Eigen::Index i = 0; i < n; ++i)
    target[i] *= std::pow(forgetting, 0.5 * static_cast<double>(n - 1 - i));
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(m, m) * ridge;
  normal.selfadjointView<Eigen::Lower>().rankUpdate(lagged);
  const Eigen::VectorXd taps = normal.selfadjointView<Eigen::Lower>().ldlt().solve(lagged * target);
  return {taps.begin(), taps.end()};
}

/// 20 log10 of the distance from the true taps over their length.
inline double misalignment_db(const Signal& taps, Signal truth) {
  truth.resize(std::max(taps.size(), truth.size()), 0.);
  return 20. * std::log10(rms(minus(truth, taps)) / rms(truth));
}

}  // namespace vibrissa::separation::test
