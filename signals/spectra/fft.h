#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace vibrissa::signals {

/// Real discrete Fourier transform of a fixed length n with its own aligned buffers (FFTW).
/// Forward: X[k] = sum_i x[i] exp(-2 pi j k i / n), k = 0 .. n/2, unscaled. Inverse: x[i] = (1/n)
/// sum ..., so inverse(forward(x)) = x. No allocation after construction; one object may be used by
/// one thread at a time, different objects by different threads. Equal input gives equal bits in
/// every run. Throws UserError unless 0 < n < 2^31. Proven by tests/signals/spectra/fft_test.cc.
class RealFft {
 public:
  explicit RealFft(std::size_t n);
  ~RealFft();
  RealFft(RealFft&&) noexcept;
  RealFft& operator=(RealFft&&) noexcept;

  std::size_t size() const { return n_; }
  std::size_t n_bins() const { return n_ / 2 + 1; }
  /// The buffers: fill one, transform, read the other. inverse() destroys spectrum().
  std::span<double> time();
  std::span<std::complex<double>> spectrum();
  void forward();
  void inverse();

 private:
  struct Plans;
  std::size_t n_;
  std::unique_ptr<Plans> plans_;
};

/// Complex discrete Fourier transform of a fixed length n with its own aligned buffers (FFTW).
/// Forward: X[k] = sum_i x[i] exp(-2 pi j k i / n). Inverse: the same with exp(+...), and without
/// 1/n: inverse(forward(x)) = n x. Otherwise as RealFft. Proven by
/// tests/signals/spectra/fft_test.cc.
class ComplexFft {
 public:
  explicit ComplexFft(std::size_t n);
  ~ComplexFft();
  ComplexFft(ComplexFft&&) noexcept;
  ComplexFft& operator=(ComplexFft&&) noexcept;

  std::size_t size() const { return n_; }
  /// The buffers: fill one, transform, read the other.
  std::span<std::complex<double>> time();
  std::span<std::complex<double>> spectrum();
  void forward();
  void inverse();

 private:
  struct Plans;
  std::size_t n_;
  std::unique_ptr<Plans> plans_;
};

/// A single forward transform of any length, scaled as RealFft.
std::vector<std::complex<double>> real_fft(std::span<const double> x);

}  // namespace vibrissa::signals
