#include "signals/excitation/multisine.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/spectra/fft.h"

namespace vibrissa::signals {

namespace {

using std::numbers::pi;

std::vector<double> line_phases(std::size_t n_lines, MultisinePhase phase, std::uint64_t seed) {
  std::vector<double> result(n_lines, 0.);
  std::mt19937_64 random(seed);
  for (std::size_t i = 0; i < n_lines; ++i) {
    const auto order = static_cast<double>(i);
    switch (phase) {
      case MultisinePhase::schroeder:
        result[i] = -pi * order * (order + 1.) / static_cast<double>(n_lines);
        break;
      case MultisinePhase::random:
        // Made from the bits, because std::uniform_real_distribution differs between libraries.
        result[i] = 2. * pi * std::ldexp(static_cast<double>(random() >> 11), -53);
        break;
      case MultisinePhase::ascending:
        result[i] = -pi / 2. + order * pi / 6.;
        break;
      case MultisinePhase::zero:
        result[i] = -pi / 2.;
        break;
    }
  }
  return result;
}

void check_frequencies(std::span<const double> frequency_hz) {
  if (frequency_hz.empty())
    throw UserError("multisine: no line is given; give at least one frequency");
  std::vector<double> sorted(frequency_hz.begin(), frequency_hz.end());
  for (const double f : sorted)
    if (!(f > 0.) || !std::isfinite(f))
      throw UserError("multisine: frequency " + to_text(f) + " Hz is not positive and finite");
  std::ranges::sort(sorted);
  const auto twice = std::ranges::adjacent_find(sorted);
  if (twice != sorted.end())
    throw UserError("multisine: frequency " + to_text(*twice) + " Hz is given twice; give it once");
}

// The largest frequency that all are whole multiples of, by Euclid's algorithm. Remainders below
// the rounding of the given numbers count as zero.
double fundamental_hz(std::span<const double> frequency_hz) {
  const double tolerance = 1e-9 * std::ranges::max(frequency_hz);
  double divisor = frequency_hz.front();
  for (double remainder : frequency_hz)
    while (remainder > tolerance) {
      divisor = std::exchange(remainder, std::abs(std::remainder(divisor, remainder)));
    }
  return divisor;
}

// Peak over one period, from samples 16 times as dense as the highest line needs.
double peak_of_sum(const Multisine& multisine) {
  constexpr std::size_t oversampling = 16;
  constexpr double largest_order = 1 << 20;
  const double fundamental = fundamental_hz(multisine.frequency_hz);
  const double highest = std::ranges::max(multisine.frequency_hz) / fundamental;
  if (highest > largest_order)
    throw UserError("multisine: the frequencies have no common period shorter than " +
                    to_text(largest_order / std::ranges::max(multisine.frequency_hz)) +
                    " s; take frequencies that are whole multiples of one resolution");
  RealFft fft(2 * oversampling * static_cast<std::size_t>(std::lround(highest)));
  for (std::size_t i = 0; i < multisine.frequency_hz.size(); ++i) {
    const auto order =
        static_cast<std::size_t>(std::lround(multisine.frequency_hz[i] / fundamental));
    fft.spectrum()[order] = std::polar(
        0.5 * multisine.amplitude[i] * static_cast<double>(fft.size()), multisine.phase_rad[i]);
  }
  fft.inverse();
  double peak = 0.;
  for (const double x : fft.time()) peak = std::max(peak, std::abs(x));
  return peak;
}

}  // namespace

std::vector<double> Multisine::sample(double sampling_rate_hz, std::size_t n_samples) const {
  assert(amplitude.size() == frequency_hz.size() && phase_rad.size() == frequency_hz.size());
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError("multisine: sampling rate " + to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
  for (const double f : frequency_hz)
    if (!(f < 0.5 * sampling_rate_hz))
      throw UserError("multisine: frequency " + to_text(f) +
                      " Hz is not below half the sampling rate of " + to_text(sampling_rate_hz) +
                      " Hz; lower the frequency or raise the sampling rate");
  std::vector<double> result(n_samples, 0.);
  for (std::size_t line = 0; line < frequency_hz.size(); ++line)
    for (std::size_t i = 0; i < n_samples; ++i) {
      // Whole cycles are taken off exactly, so that late samples are as exact as early ones.
      const double within_cycle =
          std::fmod(frequency_hz[line] * static_cast<double>(i), sampling_rate_hz);
      result[i] +=
          amplitude[line] * std::cos(2. * pi * within_cycle / sampling_rate_hz + phase_rad[line]);
    }
  return result;
}

Multisine make_multisine(std::span<const double> frequency_hz, double peak_amplitude,
                         MultisinePhase phase, std::uint64_t seed) {
  check_frequencies(frequency_hz);
  if (!(peak_amplitude >= 0.) || !std::isfinite(peak_amplitude))
    throw UserError("multisine: peak amplitude " + to_text(peak_amplitude) +
                    " is negative or not finite");
  Multisine result{.frequency_hz = {frequency_hz.begin(), frequency_hz.end()},
                   .amplitude = std::vector<double>(frequency_hz.size(), 1.),
                   .phase_rad = line_phases(frequency_hz.size(), phase, seed)};
  const double scale = peak_amplitude / peak_of_sum(result);
  for (double& amplitude : result.amplitude) amplitude *= scale;
  return result;
}

std::vector<double> multisine_lines(double low_hz, double high_hz, std::size_t n_lines,
                                    double resolution_hz) {
  const std::string request = std::to_string(n_lines) + " multisine lines in " + to_text(low_hz) +
                              " .. " + to_text(high_hz) + " Hz at a resolution of " +
                              to_text(resolution_hz) + " Hz";
  if (!(low_hz > 0.) || !(high_hz >= low_hz) || !std::isfinite(high_hz) || !(resolution_hz > 0.) ||
      !std::isfinite(resolution_hz) || n_lines == 0)
    throw UserError(request +
                    ": 0 < low <= high, a positive resolution and at least one line are needed");
  // A bound that is a multiple but for rounding counts as one.
  const double first = std::ceil(low_hz / resolution_hz * (1. - 1e-12));
  const double last = std::floor(high_hz / resolution_hz * (1. + 1e-12));
  const double n_free = last - first + 1.;
  if (static_cast<double>(n_lines) > n_free)
    throw UserError(request + ": only " + to_text(std::max(n_free, 0.)) +
                    " lines fit; take fewer lines, a wider band or a longer period");

  std::vector<double> order(n_lines);
  for (std::size_t i = 0; i < n_lines; ++i) {
    const double share =
        n_lines == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(n_lines - 1);
    const double ideal = low_hz * std::pow(high_hz / low_hz, share) / resolution_hz;
    order[i] = std::clamp(std::round(ideal), first, last);
    if (i > 0) order[i] = std::max(order[i], order[i - 1] + 1.);
  }
  for (std::size_t i = 0; i < n_lines; ++i) {
    const double n_behind = static_cast<double>(n_lines - 1 - i);
    order[i] = std::min(order[i], last - n_behind) * resolution_hz;
  }
  return order;
}

double crest_factor(std::span<const double> x) {
  double peak = 0., sum_of_squares = 0.;
  for (const double value : x) {
    peak = std::max(peak, std::abs(value));
    sum_of_squares += value * value;
  }
  if (!(sum_of_squares > 0.))
    throw UserError(
        "crest factor: the signal is empty or zero at every sample; its crest factor is not "
        "defined");
  return peak / std::sqrt(sum_of_squares / static_cast<double>(x.size()));
}

}  // namespace vibrissa::signals
