#include "separation/ringdown/decay_pieces.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "signals/base/error.h"
#include "signals/base/is_constant.h"
#include "signals/base/median.h"
#include "signals/spectra/fft.h"
#include "signals/spectra/resample.h"

namespace vibrissa::separation {

namespace {

/// Frequency of the largest line of the moment's rate, which shows steps and drift little [Hz].
double strongest_line_hz(std::span<const double> moment, const double rate_hz) {
  constexpr std::size_t lowest_line = 5;
  const std::vector<std::complex<double>> lines = signals::real_fft(signals::remove_mean(moment));
  std::size_t best = lowest_line;
  const auto rate = [&](std::size_t k) { return static_cast<double>(k) * std::abs(lines[k]); };
  for (std::size_t k = lowest_line; k < lines.size(); ++k)
    if (rate(k) > rate(best)) best = k;
  return static_cast<double>(best) * rate_hz / static_cast<double>(moment.size());
}

/// Amplitude of a sine of the mode's frequency in blocks of one period, about their means.
std::vector<double> amplitudes(std::span<const double> moment, const std::size_t block) {
  std::vector<double> out;
  for (std::size_t first = 0; first + block <= moment.size(); first += block) {
    const std::span<const double> part = moment.subspan(first, block);
    double mean = 0., power = 0.;
    for (const double m : part) mean += m / static_cast<double>(block);
    for (const double m : part) power += (m - mean) * (m - mean) / static_cast<double>(block);
    out.push_back(std::sqrt(2. * power));
  }
  return out;
}

/// Amplitude of the quietest twentieth of the blocks.
double quietest(std::vector<double> amplitude) {
  const std::size_t n = std::max<std::size_t>(1, amplitude.size() / 20);
  std::ranges::nth_element(amplitude, amplitude.begin() + static_cast<std::ptrdiff_t>(n - 1));
  return signals::median(
      std::vector(amplitude.begin(), amplitude.begin() + static_cast<std::ptrdiff_t>(n)));
}

}  // namespace

Decays find_decays(std::span<const double> moment, const double sampling_rate_hz) {
  constexpr std::size_t fewest_samples = 50, fewest_periods = 5;
  constexpr double rise = 1.5, noise_ends = 1.5, least_fall = 3.;
  if (moment.size() < fewest_samples)
    throw signals::UserError("ring-down: " + std::to_string(moment.size()) +
                             " samples are too few; record the whole decay");
  if (!std::ranges::all_of(moment, [](double m) { return std::isfinite(m); }))
    throw signals::UserError("ring-down: the moment has a value that is not finite");
  if (signals::is_constant(moment))
    throw signals::UserError("ring-down: the moment is constant; is it the right column?");
  Decays out{.pieces = {}, .frequency_hz = strongest_line_hz(moment, sampling_rate_hz)};
  const auto block =
      static_cast<std::size_t>(std::max(3., std::round(sampling_rate_hz / out.frequency_hz)));
  const std::vector<double> amplitude = amplitudes(moment, block);
  const double quiet = quietest(amplitude);
  out.noise_rms = quiet / std::sqrt(2.);
  for (std::size_t i = 0; i < amplitude.size();) {
    std::size_t end = i + 1;
    double lowest = amplitude[i];
    while (end < amplitude.size() && amplitude[end] < rise * lowest &&
           amplitude[end] > noise_ends * quiet)
      lowest = std::min(lowest, amplitude[end++]);
    // The first block may hold the hit itself.
    const std::size_t first = i + 1;
    if (end > first + fewest_periods && amplitude[first] > least_fall * amplitude[end - 1])
      out.pieces.push_back({first * block, end * block});
    i = end;
  }
  if (out.pieces.empty())
    throw signals::UserError(
        "ring-down: no free decay was found: at " + std::to_string(out.frequency_hz) +
        " Hz, the strongest line, the moment never falls to a third over at least five periods. If "
        "the record ends before that, record longer; if it falls within fewer periods, identify "
        "the sensor under base motion; if the line is hum or the base moves, remove that");
  return out;
}

}  // namespace vibrissa::separation
