#include "diagnosis/records/source_samples.h"

#include <algorithm>
#include <boost/math/statistics/linear_regression.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

constexpr double source_rates_hz[] = {800., 1600.,
                                      3200.};  // of the ADXL345, above usual sampling rates

/// Periodic pattern of the ages of the samples [samples], without their mean.
using Ages = std::vector<double>;

/// All age patterns of a source rate; empty when the rates have no simple ratio, or when the ages
/// differ so much that the fastest signals cannot be restored.
std::vector<Ages> patterns(const double source_hz, const double rate_hz) {
  constexpr int longest = 8;
  constexpr double largest_rad = 1.;
  for (int q = 2; q <= longest; ++q) {
    const double p = source_hz / rate_hz * q;
    const long step = std::lround(p);
    if (std::abs(p - static_cast<double>(step)) > 1e-9 || std::gcd(step, long{q}) != 1) continue;
    const double unit = rate_hz / source_hz / q;
    if (std::numbers::pi * 0.5 * (q - 1) * unit > largest_rad) return {};
    std::vector<Ages> out;
    for (long shift = 0; shift < q; ++shift) {
      Ages ages;
      for (long k = 0; k < q; ++k)
        ages.push_back(unit * (static_cast<double>((k * step + shift) % q) - 0.5 * (q - 1)));
      out.push_back(std::move(ages));
    }
    return out;
  }
  return {};
}

/// The samples of a signal with the given spectrum at these ages.
std::vector<double> aged(const std::vector<Complex>& spectrum, const std::size_t n,
                         const Ages& ages) {
  std::vector<double> out(n);
  std::vector<Complex> late(spectrum.size());
  for (std::size_t phase = 0; phase < ages.size(); ++phase) {
    const double per_line = -2. * std::numbers::pi * ages[phase] / static_cast<double>(n);
    for (std::size_t k = 0; k < late.size(); ++k)
      late[k] = spectrum[k] * std::polar(1., per_line * static_cast<double>(k));
    const std::vector<double> samples = samples_of(late, n);
    for (std::size_t i = phase; i < n; i += ages.size()) out[i] = samples[i];
  }
  return out;
}

/// The signal whose samples at these ages are x, by fixed-point iteration of the residual.
std::vector<double> evened(const std::span<const double> x, const Ages& ages, const int n_passes) {
  std::vector<double> y(x.begin(), x.end());
  for (int pass = 0; pass < n_passes; ++pass) {
    const std::vector<double> read = aged(spectrum_of(y), x.size(), ages);
    for (std::size_t i = 0; i < x.size(); ++i) y[i] += x[i] - read[i];
  }
  return y;
}

/// Smallest mean power per line of any eighth of the spectrum, without leakage of the record's
/// ends.
double quietest(std::vector<double> x) {
  constexpr std::size_t n_parts = 8;
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] *= std::pow(
        std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(x.size())),
        2);
  const std::vector<double> power = powers(spectrum_of(x));
  const auto n = static_cast<std::ptrdiff_t>(power.size() / n_parts);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t part = 0; part < n_parts; ++part) {
    const auto first = power.begin() + static_cast<std::ptrdiff_t>(part) * n;
    least = std::min(least, std::accumulate(first, first + n, 0.) / static_cast<double>(n));
  }
  return least;
}

/// Indices where runs of equal samples begin.
std::vector<std::size_t> run_starts(const std::span<const double> x) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (i == 0 || x[i] != x[i - 1]) out.push_back(i);
  return out;
}

struct Line {
  double intercept = 0., slope = 1.;
};

/// Least-squares line of the indices over their numbers.
Line line_through(const std::vector<std::size_t>& indices) {
  if (indices.size() < 2) return {indices.empty() ? 0. : static_cast<double>(indices.front())};
  std::vector<double> numbers(indices.size());
  std::iota(numbers.begin(), numbers.end(), 0.);
  const auto [intercept, slope] = boost::math::statistics::simple_ordinary_least_squares(
      numbers, std::vector<double>(indices.begin(), indices.end()));
  return {intercept, slope};
}

}  // namespace

std::optional<EvenedSeries> evened_series(const std::span<const double> x, const double rate_hz) {
  constexpr std::size_t fewest = 256;
  constexpr int n_trial_passes = 1, n_passes = 20;
  constexpr double much = 2.;
  const std::size_t n = x.size() - x.size() % 2;
  if (n < fewest) return std::nullopt;
  const std::span<const double> even_part = x.first(n);
  const double as_read = quietest({even_part.begin(), even_part.end()});
  double least = as_read / much;
  Ages best;
  for (const double source_hz : source_rates_hz)
    for (const Ages& ages : patterns(source_hz, rate_hz)) {
      const double left = quietest(evened(even_part, ages, n_trial_passes));
      if (left >= least) continue;
      least = left;
      best = ages;
    }
  if (best.empty()) return std::nullopt;
  EvenedSeries out{evened(even_part, best, n_passes)};
  if (n < x.size()) out.samples.push_back(x.back());
  // Step between two ages.
  out.unknown_age =
      (*std::max_element(best.begin(), best.end()) - *std::min_element(best.begin(), best.end())) /
      static_cast<double>(best.size() - 1);
  return out;
}

double repeat_share(const std::span<const double> x) {
  if (x.empty()) return 0.;
  return 1. - static_cast<double>(run_starts(x).size()) / static_cast<double>(x.size());
}

bool is_held(const std::span<const double> x) {
  constexpr double many = 0.08;
  return repeat_share(x) > many && std::set<double>(x.begin(), x.end()).size() > x.size() / 4;
}

std::vector<double> new_sample_series(const std::span<const double> x) {
  std::vector<std::size_t> indices = run_starts(x);
  if (indices.size() % 2 != 0) indices.pop_back();
  if (indices.empty()) return {x.begin(), x.end()};
  std::vector<double> source;
  for (const std::size_t index : indices) source.push_back(x[index]);
  const Line line = line_through(indices);
  return resampled(spectrum_of(source), source.size(), x.size(), -line.intercept / line.slope,
                   1. / line.slope);
}

double unknown_age(const std::span<const double> x) {
  constexpr int longest = 16;
  const double period = line_through(run_starts(x)).slope;
  for (int q = 1; q <= longest; ++q) {
    const double n_source_samples = q / period;
    // The position in the period drifts by less than a step over the whole record.
    if (std::abs(n_source_samples - std::round(n_source_samples)) * static_cast<double>(x.size()) <
        1.)
      return period / q;
  }
  return 0.;
}

}  // namespace vibrissa::diagnosis
