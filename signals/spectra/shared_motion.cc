#include "signals/spectra/shared_motion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "signals/base/median.h"
#include "signals/spectra/fft.h"

namespace vibrissa::signals {

namespace {

using Values = std::vector<double>;

/// Without mean, flat in frequency where it is above a thousandth of its strongest band.
Values whitened(const std::span<const double> x) {
  constexpr std::size_t n_bands = 128;
  constexpr double floor_share = 1e-3;
  RealFft fft(x.size());
  const double mean = std::accumulate(x.begin(), x.end(), 0.) / double(x.size());
  std::ranges::transform(x, fft.time().begin(), [&](const double value) { return value - mean; });
  fft.forward();
  const auto spectrum = fft.spectrum();
  Values sums(spectrum.size() + 1, 0.);
  for (std::size_t k = 0; k < spectrum.size(); ++k) sums[k + 1] = sums[k] + std::norm(spectrum[k]);
  const std::size_t reach = std::max<std::size_t>(1, spectrum.size() / (2 * n_bands));
  Values power(spectrum.size());
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const std::size_t from = k > reach ? k - reach : 0,
                      to = std::min(spectrum.size(), k + reach + 1);
    power[k] = (sums[to] - sums[from]) / double(to - from);
  }
  const double least = floor_share * *std::ranges::max_element(power);
  if (least == 0.) return Values(x.size(), 0.);
  for (std::size_t k = 0; k < spectrum.size(); ++k) spectrum[k] /= std::sqrt(power[k] + least);
  fft.inverse();
  return {fft.time().begin(), fft.time().end()};
}

/// Correlation coefficient of one window of the pattern with every place in the signal.
struct Correlation {
  std::size_t at = 0;
  Values r;
  double n_effective = 0.;

  double evidence(const double value) const {
    return -0.5 * n_effective * std::log(std::max(1e-12, 1. - value * value));
  }
  /// Variance of the evidence between places with the same motion, whose noise differs.
  double variance(const double value) const {
    const double share = std::min(1., value * value / std::max(1e-12, 1. - value * value));
    return n_effective * share * share;
  }
};

class Correlator {
 public:
  Correlator(const Values& signal, const std::size_t length)
      : length_(length),
        n_places_(signal.size() - length + 1),
        fft_(std::bit_ceil(signal.size() + length)),
        energy_(signal.size() + 1, 0.) {
    for (std::size_t i = 0; i < signal.size(); ++i)
      energy_[i + 1] = energy_[i] + signal[i] * signal[i];
    transform(signal);
    signal_.assign(fft_.spectrum().begin(), fft_.spectrum().end());
  }

  Correlation at(const Values& pattern, const std::size_t first) {
    const auto window = std::span(pattern).subspan(first, length_);
    const double own = std::inner_product(window.begin(), window.end(), window.begin(), 0.);
    transform(window);
    const auto spectrum = fft_.spectrum();
    for (std::size_t k = 0; k < spectrum.size(); ++k)
      spectrum[k] = signal_[k] * std::conj(spectrum[k]);
    fft_.inverse();
    // A silent place must not win by its silence.
    const double least = 1e-3 * energy_.back() * double(length_) / double(energy_.size() - 1);
    Correlation result{first, Values(n_places_, 0.), 0.};
    for (std::size_t i = 0; i < n_places_; ++i) {
      const double energy = energy_[i + length_] - energy_[i] + least;
      if (own > 0. && energy > 0.) result.r[i] = fft_.time()[i] / std::sqrt(own * energy);
    }
    Values size(n_places_);
    std::ranges::transform(result.r, size.begin(), [](const double r) { return std::abs(r); });
    const double deviation = robust_deviation(std::move(size));
    result.n_effective = deviation > 0. ? 1. / (deviation * deviation) : 0.;
    return result;
  }

 private:
  void transform(const std::span<const double> x) {
    std::ranges::fill(fft_.time(), 0.);
    std::ranges::copy(x, fft_.time().begin());
    fft_.forward();
  }

  std::size_t length_, n_places_;
  RealFft fft_;
  Values energy_;
  std::vector<std::complex<double>> signal_;
};

/// All windows under the hypothesis that one of them lies at a place.
struct Line {
  double shift = 0., at = 0.;  // place minus first sample of the window that proposes it
  double sign = 1., evidence = 0., variance = 0.;
};

struct Place {
  std::size_t index = 0;
  double r = 0.;  // times the sign
};

Place best_place(const Correlation& window, const Line& line, const SharedMotionSearch& search) {
  const double at = double(window.at);
  const double reach = search.largest_drift * std::abs(at - line.at) + search.lobe_samples;
  const double last = double(window.r.size()) - 1.;
  Place best{0, 0.};
  for (double i = std::max(0., std::ceil(at + line.shift - reach));
       i <= std::min(last, at + line.shift + reach); i += 1.) {
    const double r = line.sign * window.r[std::size_t(i)];
    if (r > best.r) best = {std::size_t(i), r};
  }
  return best;
}

/// The strongest places of a window, apart by more than the lobe.
std::vector<std::size_t> strongest(const Correlation& window, const double lobe) {
  constexpr std::size_t n_taken = 3;
  std::vector<std::size_t> taken;
  Values r(window.r.size());
  std::ranges::transform(window.r, r.begin(), [](const double value) { return std::abs(value); });
  while (taken.size() < n_taken) {
    const auto best = std::size_t(std::ranges::max_element(r) - r.begin());
    if (r[best] <= 0.) break;
    taken.push_back(best);
    const auto reach = std::size_t(lobe);
    for (std::size_t i = best > reach ? best - reach : 0; i < std::min(r.size(), best + reach + 1);
         ++i)
      r[i] = 0.;
  }
  return taken;
}

std::vector<Line> proposed_lines(const std::vector<Correlation>& windows,
                                 const SharedMotionSearch& search) {
  std::vector<Line> lines;
  for (const Correlation& window : windows) {
    for (const std::size_t place : strongest(window, search.lobe_samples)) {
      Line line{double(place) - double(window.at), double(window.at),
                window.r[place] < 0. ? -1. : 1., 0., 0.};
      for (const Correlation& other : windows) {
        const double r = best_place(other, line, search).r;
        line.evidence += other.evidence(r);
        line.variance += other.variance(r);
      }
      lines.push_back(line);
    }
  }
  std::ranges::sort(lines, std::greater{}, &Line::evidence);
  return lines;
}

bool is_same(const Line& a, const Line& b, const SharedMotionSearch& search) {
  return std::abs(a.shift - b.shift) <=
         search.largest_drift * std::abs(a.at - b.at) + 2. * search.lobe_samples;
}

bool is_told_apart(const std::vector<Line>& lines, const SharedMotionSearch& search) {
  constexpr double deviations = 5.;  // the best of all repetitions is compared
  const double needed = std::log(1000.) + deviations * std::sqrt(lines.front().variance);
  const auto next = std::ranges::find_if(
      lines, [&](const Line& line) { return !is_same(line, lines.front(), search); });
  return lines.front().evidence - (next == lines.end() ? 0. : next->evidence) > needed;
}

/// Top of the parabola through three places.
MatchedWindow matched(const Correlation& window, const Place& place, const double sign) {
  double shift = 0.;
  if (place.index > 0 && place.index + 1 < window.r.size()) {
    const double before = sign * window.r[place.index - 1],
                 after = sign * window.r[place.index + 1];
    const double curvature = before - 2. * place.r + after;
    if (curvature < 0.) shift = std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
  }
  const double r2 = place.r * place.r;
  return {double(window.at), double(place.index) + shift,
          window.n_effective * r2 / std::max(1e-6, 1. - r2)};
}

}  // namespace

SharedMotionMatch find_shared_motion(const std::span<const double> signal,
                                     const std::span<const double> pattern,
                                     const SharedMotionSearch& search) {
  constexpr std::size_t shortest = 64, longest = 4096, n_windows = 24;
  const std::size_t length = std::min(std::min(signal.size(), pattern.size()) / 8, longest);
  if (length < shortest) return {};
  const Values white = whitened(signal), parts = whitened(pattern);
  Correlator correlator(white, length);
  std::vector<Correlation> windows;
  const std::size_t n = std::min(n_windows, pattern.size() / length);
  for (std::size_t k = 0; k < n; ++k)
    windows.push_back(correlator.at(parts, k * (pattern.size() - length) / (n - 1)));
  const std::vector<Line> lines = proposed_lines(windows, search);
  if (lines.empty() || !is_told_apart(lines, search)) return {};
  SharedMotionMatch match{{}, lines.front().sign < 0.};
  for (const Correlation& window : windows) {
    const Place place = best_place(window, lines.front(), search);
    // Of unrelated noise the largest of the few places here is lower.
    if (window.evidence(place.r) > std::log(1000.))
      match.windows.push_back(matched(window, place, lines.front().sign));
  }
  return match;
}

}  // namespace vibrissa::signals
