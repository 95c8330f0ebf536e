#include "diagnosis/records/spectrum.h"

#include <algorithm>
#include <cassert>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "signals/base/median.h"
#include "signals/spectra/fft.h"

namespace vibrissa::diagnosis {
namespace {

signals::RealFft& plan(const std::size_t n) {
  thread_local std::unordered_map<std::size_t, signals::RealFft> plans;
  const auto found = plans.find(n);
  if (found != plans.end()) return found->second;
  return plans.emplace(n, signals::RealFft(n)).first->second;
}

double sinc_squared(const double x) {
  const double angle = std::numbers::pi * x;
  return std::abs(angle) < 1e-9 ? 1. : std::pow(std::sin(angle) / angle, 2);
}

}  // namespace

std::vector<Complex> spectrum_of(std::span<const double> x) {
  signals::RealFft& fft = plan(x.size());
  std::copy(x.begin(), x.end(), fft.time().begin());
  fft.forward();
  return {fft.spectrum().begin(), fft.spectrum().end()};
}

std::vector<double> samples_of(std::span<const Complex> spectrum, const std::size_t n) {
  signals::RealFft& fft = plan(n);
  assert(spectrum.size() == fft.n_bins());
  std::copy(spectrum.begin(), spectrum.end(), fft.spectrum().begin());
  fft.inverse();
  return {fft.time().begin(), fft.time().end()};
}

std::vector<Complex> passed(std::vector<Complex> spectrum, const std::size_t n,
                            const double rate_hz,
                            const std::function<Complex(Complex s)>& response) {
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    spectrum[k] *= response(
        {0., 2. * std::numbers::pi * rate_hz * static_cast<double>(k) / static_cast<double>(n)});
  return spectrum;
}

std::vector<Complex> nominal_moment(const NominalModel& nominal, const std::size_t n,
                                    const double rate_hz,
                                    const std::span<const double> acceleration,
                                    const std::span<const double> wind) {
  std::vector<Complex> out(n / 2 + 1, 0.);
  const auto add = [&](const std::span<const double> input, const auto& response) {
    if (input.empty()) return;
    const std::vector<Complex> part = passed(spectrum_of(input), n, rate_hz, response);
    std::ranges::transform(out, part, out.begin(), std::plus());
  };
  add(acceleration, [&](Complex s) { return nominal.base_response(s); });
  std::vector<double> force(wind.begin(), wind.end());
  for (double& u : force) u = nominal.drag_curve.drag(u);
  add(force, [&](Complex s) { return nominal.wind_response(s); });
  return out;
}

std::vector<double> upsampled(std::span<const Complex> spectrum, const std::size_t n,
                              const std::size_t factor) {
  if (factor == 1) return samples_of(spectrum, n);
  signals::RealFft& fft = plan(n * factor);
  const auto out = fft.spectrum();
  const double scale = static_cast<double>(factor);
  for (std::size_t k = 0; k < spectrum.size(); ++k) out[k] = scale * spectrum[k];
  if (n % 2 == 0) out[spectrum.size() - 1] *= 0.5;
  std::fill(out.begin() + static_cast<std::ptrdiff_t>(spectrum.size()), out.end(), Complex(0.));
  fft.inverse();
  return {fft.time().begin(), fft.time().end()};
}

std::vector<double> resampled(const std::span<const Complex> spectrum, const std::size_t n,
                              const std::size_t n_out, const double start, const double step) {
  constexpr std::size_t factor = 4;
  const std::vector<double> fine = upsampled(spectrum, n, factor);
  std::vector<double> out(n_out);
  const auto size = static_cast<std::ptrdiff_t>(fine.size());
  for (std::size_t i = 0; i < n_out; ++i) {
    const double index = factor * (start + static_cast<double>(i) * step);
    const double floor = std::floor(index), x = index - floor;
    const auto at = [&](std::ptrdiff_t d) {
      return fine[static_cast<std::size_t>(
          ((static_cast<std::ptrdiff_t>(floor) + d) % size + size) % size)];
    };
    const double a = at(-1), b = at(0), c = at(1), e = at(2);
    out[i] = b + x * (c - a / 3. - b / 2. - e / 6. +
                      x * ((a + c) / 2. - b + x * ((e - a) / 6. + (b - c) / 2.)));
  }
  return out;
}

std::vector<Complex> difference(std::span<const Complex> a, std::span<const Complex> b) {
  std::vector<Complex> out(a.size());
  std::ranges::transform(a, b, out.begin(), std::minus());
  return out;
}

std::vector<double> powers(std::span<const Complex> x) {
  std::vector<double> out(x.size());
  std::transform(x.begin(), x.end(), out.begin(), [](Complex v) { return std::norm(v); });
  return out;
}

double total_power(std::span<const Complex> x) {
  return std::transform_reduce(x.begin(), x.end(), 0., std::plus(),
                               [](const Complex& value) { return std::norm(value); });
}

std::vector<double> signed_squares(std::span<const double> u) {
  std::vector<double> out(u.begin(), u.end());
  for (double& value : out) value *= std::abs(value);
  return out;
}

double mean_square(std::span<const double> x) {
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.) / static_cast<double>(x.size());
}

double rms_about_mean(std::span<const double> x) {
  const double mean = std::accumulate(x.begin(), x.end(), 0.) / static_cast<double>(x.size());
  std::vector<double> rest(x.begin(), x.end());
  for (double& v : rest) v -= mean;
  return std::sqrt(mean_square(rest));
}

std::vector<double> neighbour_mean(std::span<const double> x, const std::size_t reach) {
  std::vector<double> running(x.size() + 1, 0.), out(x.size());
  std::partial_sum(x.begin(), x.end(), running.begin() + 1);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const std::size_t low = k < reach ? 0 : k - reach, high = std::min(x.size(), k + reach + 1);
    out[k] = (running[high] - running[low]) / static_cast<double>(high - low);
  }
  return out;
}

double colour(std::vector<double> power) {
  if (power.empty()) return 1.;
  const double mean =
      std::accumulate(power.begin(), power.end(), 0.) / static_cast<double>(power.size());
  const double median = signals::median(std::move(power));
  return median > 0. ? mean * std::numbers::ln2 / median : 1.;
}

std::size_t fast_length(std::size_t n) {
  for (n -= n % 2; n > 2; n -= 2) {
    std::size_t rest = n;
    for (const std::size_t factor : {2, 3, 5, 7})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) break;
  }
  return n;
}

std::vector<double> share_at_bins(std::span<const double> share_at_lines,
                                  const std::size_t n_samples, const std::size_t n_evaluated) {
  if (n_evaluated + 1 >= n_samples) return {share_at_lines.begin() + 1, share_at_lines.end() - 1};
  constexpr double reach = 12.;  // lines; farther lines contribute less than a hundredth
  const double bin_per_line = static_cast<double>(n_evaluated) / static_cast<double>(n_samples);
  std::vector<double> bins(n_evaluated / 2 - 1);
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const double at_line = static_cast<double>(b + 1) / bin_per_line;
    const auto first = static_cast<std::size_t>(std::max(0., std::ceil(at_line - reach)));
    const auto last =
        std::min(share_at_lines.size() - 1, static_cast<std::size_t>(at_line + reach));
    double sum = 0., weights = 0.;
    for (std::size_t k = first; k <= last; ++k) {
      const double weight = sinc_squared((static_cast<double>(k) - at_line) * bin_per_line);
      sum += weight * share_at_lines[k];
      weights += weight;
    }
    bins[b] = sum / weights;
  }
  return bins;
}

}  // namespace vibrissa::diagnosis
