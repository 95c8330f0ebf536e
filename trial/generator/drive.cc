#include "trial/generator/drive.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "signals/spectra/fft.h"

namespace vibrissa::trial {
namespace {

std::vector<double> scaled(signals::RealFft& fft, const double rms) {
  fft.inverse();
  std::vector<double> out(fft.time().begin(), fft.time().end());
  double power = 0.;
  for (const double v : out) power += v * v;
  const double factor = power > 0. ? rms * std::sqrt(static_cast<double>(out.size()) / power) : 0.;
  for (double& v : out) v *= factor;
  return out;
}

}  // namespace

std::vector<double> odd_multisine(const std::size_t n, const double rate_hz, const double low_hz,
                                  const double high_hz, const double rms,
                                  const std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> phase(0., 2. * std::numbers::pi);
  signals::RealFft fft(n);
  const double line_hz = rate_hz / static_cast<double>(n);
  for (std::complex<double>& line : fft.spectrum()) line = 0.;
  for (std::size_t k = 1; k < fft.n_bins(); k += 2) {
    const double f = static_cast<double>(k) * line_hz;
    if (f < low_hz || f > high_hz || (k / 2) % 4 == 1) continue;
    fft.spectrum()[k] = std::polar(1., phase(random));
  }
  return scaled(fft, rms);
}

std::vector<double> band_noise(const std::size_t n, const double rate_hz, const double low_hz,
                               const double high_hz, const double rms, const std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  signals::RealFft fft(n);
  const double line_hz = rate_hz / static_cast<double>(n);
  for (std::size_t k = 0; k < fft.n_bins(); ++k) {
    const double f = static_cast<double>(k) * line_hz;
    const bool inside = f >= low_hz && f <= high_hz;
    const double re = normal(random), im = normal(random);
    fft.spectrum()[k] = inside ? std::complex<double>(re, im) : 0.;
  }
  return scaled(fft, rms);
}

std::vector<double> below(std::vector<double> x, const double rate_hz, const double high_hz) {
  signals::RealFft fft(x.size());
  std::copy(x.begin(), x.end(), fft.time().begin());
  fft.forward();
  const double line_hz = rate_hz / static_cast<double>(x.size());
  for (std::size_t k = 0; k < fft.n_bins(); ++k)
    if (static_cast<double>(k) * line_hz > high_hz) fft.spectrum()[k] = 0.;
  fft.inverse();
  std::copy(fft.time().begin(), fft.time().end(), x.begin());
  return x;
}

}  // namespace vibrissa::trial
