#include "checks/response_change.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>

#include "diagnosis/localisation/significance_tests.h"
#include "diagnosis/records/experiment.h"
#include "separation/verdict/coherence.h"
#include "signals/base/is_constant.h"
#include "signals/spectra/fft.h"

namespace vibrissa::checks {
namespace {

namespace channel = signals::channel;
using Complex = std::complex<double>;

/// A stretch of the record: responses of its parts at the lines in question.
struct Stretch {
  std::vector<double> coherence, power;  // power: of the input, over its total
  double limit = 1.;
  std::vector<std::vector<Complex>> parts;
};

using Stretches = std::vector<Stretch>;

void set_shares(std::vector<double> density, Stretch& out) {
  double total = 0.;
  for (const double d : density) total += d;
  for (double& d : density) d /= total;
  out.power = std::move(density);
}

Stretch stretch_by_welch(const signals::Record& record, std::size_t n_parts,
                         const signals::WelchOptions& options) {
  const auto response_of = [&](const signals::Record& part) {
    return signals::welch_response(part.channel(channel::base_acceleration),
                                   part.channel(channel::base_moment), part.sampling_rate_hz(),
                                   options);
  };
  Stretch out;
  out.coherence = response_of(record).coherence;
  const auto spectrum = signals::welch_spectrum(record.channel(channel::base_acceleration),
                                                record.sampling_rate_hz(), options);
  set_shares({spectrum.density.begin() + 1,
              spectrum.density.begin() + 1 + std::ptrdiff_t(out.coherence.size())},
             out);
  out.limit = separation::coherence_limit(out.coherence.size(),
                                          signals::welch_averages(record.n_samples(), options));
  const std::size_t length = record.n_samples() / n_parts;
  for (std::size_t p = 0; p < n_parts; ++p)
    out.parts.push_back(response_of(record.slice(p * length, length)).value);
  return out;
}

/// Whether a part of the record is without any drive.
bool has_rest(const signals::Record& record, std::size_t length) {
  const auto input = record.channel(channel::base_acceleration);
  for (std::size_t first = 0; first + length <= input.size(); first += length)
    if (signals::is_constant(input.subspan(first, length))) return true;
  return false;
}

/// Thirds with four parts each; leakage differs from part to part, and counts as noise.
Stretches thirds_of(const signals::Record& record) {
  constexpr std::size_t n_thirds = 3, n_parts = 4, shortest = 32, longest = 1024;
  const std::size_t length = record.n_samples() / n_thirds, part = length / n_parts;
  const std::size_t segment = std::clamp(std::bit_floor(part / 4), shortest, longest);
  if (part < 4 * segment || has_rest(record, part)) return {};
  Stretches out;
  for (std::size_t i = 0; i < n_thirds; ++i)
    out.push_back(
        stretch_by_welch(record.slice(i * length, length), n_parts, {.segment_samples = segment}));
  return out;
}

Stretch stretch_of_periods(const signals::Record& record, std::size_t period,
                           std::size_t first_period, std::size_t n_periods) {
  Stretch out;
  const auto a = record.channel(channel::base_acceleration),
             m = record.channel(channel::base_moment);
  std::vector<double> density(period / 2 - 1, 0.);
  for (std::size_t p = 0; p < n_periods; ++p) {
    const std::size_t first = (first_period + p) * period;
    const auto u = signals::real_fft(a.subspan(first, period)),
               y = signals::real_fft(m.subspan(first, period));
    std::vector<Complex> response;
    for (std::size_t k = 0; k < density.size(); ++k) {
      density[k] += std::norm(u[k + 1]);
      response.push_back(y[k + 1] / u[k + 1]);
    }
    out.parts.push_back(std::move(response));
  }
  out.coherence.assign(density.size(), 1.);
  out.limit = 0.;
  set_shares(std::move(density), out);
  return out;
}

/// A drive that repeats has no leakage in whole periods; the first one holds the transient. Its
/// other periods make three stretches, or two when they are few.
Stretches stretches_of_periods(const signals::Record& record, std::size_t period) {
  constexpr std::size_t fewest_a_stretch = 2;
  const std::size_t n_periods = record.n_samples() / period - 1;
  const std::size_t n = std::min<std::size_t>(3, n_periods / fewest_a_stretch);
  if (n < 2) return {};
  Stretches out;
  for (std::size_t i = 0; i < n; ++i)
    out.push_back(stretch_of_periods(record, period, 1 + i * (n_periods / n), n_periods / n));
  return out;
}

/// Whether each stretch excites the line, and with the same share of its power.
bool is_excited_alike(const Stretches& stretches, std::size_t line) {
  constexpr double alike = 4., weak = 1e-2;
  double least = 1., most = 0.;
  for (const Stretch& stretch : stretches) {
    if (!(stretch.coherence[line] > stretch.limit)) return false;
    for (const auto& part : stretch.parts)
      if (!std::isfinite(std::abs(part[line]))) return false;
    if (stretch.power[line] < weak * std::ranges::max(stretch.power)) return false;
    least = std::min(least, stretch.power[line]);
    most = std::max(most, stretch.power[line]);
  }
  return most < alike * least;
}

/// Mean squares of one line, per complex degree of freedom.
struct LineVariance {
  double between = 0., within = 0., mean_square = 0., power = 0.;
};

LineVariance variance_of(const Stretches& stretches, std::size_t line) {
  const double n = double(stretches.size()), n_parts = double(stretches[0].parts.size());
  std::vector<Complex> means(stretches.size());
  Complex mean = 0.;
  LineVariance out;
  for (std::size_t t = 0; t < stretches.size(); ++t) {
    for (const auto& part : stretches[t].parts) means[t] += part[line] / n_parts;
    mean += means[t] / n;
    out.power += stretches[t].power[line] / n;
    for (const auto& part : stretches[t].parts)
      out.within += std::norm(part[line] - means[t]) / (n * (n_parts - 1.));
  }
  for (const Complex& other : means) out.between += n_parts * std::norm(other - mean) / (n - 1.);
  out.mean_square = std::norm(mean);
  return out;
}

/// n_tied: neighbours that the window ties to each other.
double chance_of(const std::vector<LineVariance>& lines, const Stretches& stretches,
                 double n_tied) {
  const double n = double(stretches.size()), n_parts = double(stretches[0].parts.size()),
               n_between = 2. * (n - 1.), n_within = 2. * n * (n_parts - 1.);
  double sum = 0.;
  std::vector<double> chances;
  for (const LineVariance& line : lines) {
    const double ratio = line.between / line.within;
    sum += diagnosis::variance_ratio_deviate(ratio, n_between, n_within);
    chances.push_back(diagnosis::variance_ratio_tail(ratio, n_between, n_within));
  }
  const double together = diagnosis::normal_tail(sum / std::sqrt(n_tied * double(lines.size())));
  const double largest = std::ranges::min(diagnosis::holm_corrected(chances));
  return std::min(1., 2. * std::min(together, largest));
}

}  // namespace

std::optional<ResponseChange> response_change(const signals::Record& record,
                                              const std::size_t period_samples) {
  const bool repeats = period_samples > 0;
  const Stretches stretches =
      repeats ? stretches_of_periods(record, period_samples) : thirds_of(record);
  if (stretches.empty()) return std::nullopt;
  std::vector<LineVariance> lines;
  for (std::size_t line = 1; line < stretches[0].power.size(); ++line)
    if (is_excited_alike(stretches, line)) lines.push_back(variance_of(stretches, line));
  constexpr std::size_t fewest_lines = 3;
  if (lines.size() < fewest_lines) return std::nullopt;
  // Under the Hann window (separation/metrics/coherent_power.cc).
  constexpr double tied_lines = 1. + 2. * (4. / 9. + 1. / 36.);
  ResponseChange out{.p_value = chance_of(lines, stretches, repeats ? 1. : tied_lines)};
  double change = 0., response = 0.;
  for (const LineVariance& line : lines) {
    change += line.power * (line.between - line.within) / double(stretches[0].parts.size());
    response += line.power * line.mean_square;
  }
  constexpr double most_chance = 1e-3;
  if (!(out.p_value < most_chance) ||
      !(change > response * diagnosis::power_without_cause(diagnosis::usual_simulation_accuracy)))
    return std::nullopt;
  out.share = std::sqrt(change / response);
  return out;
}

}  // namespace vibrissa::checks
