#include "diagnosis/records/channel_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnosis/records/source_samples.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/median.h"

namespace vibrissa::diagnosis {
namespace {

using signals::DatasetRecord;
namespace channel = signals::channel;

/// Smallest power per line of any eighth of the spectrum, by the median: noise plus remaining
/// signal.
double quietest_power(const std::vector<Complex>& spectrum) {
  constexpr std::size_t n_parts = 8;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t n = (spectrum.size() - 2) / n_parts;
  for (std::size_t part = 0; n > 0 && part < n_parts; ++part)
    least = std::min(least, signals::median(powers(std::span(spectrum).subspan(1 + part * n, n))) /
                                std::numbers::ln2);
  return least;
}

/// The readings of a channel in all fit records.
std::vector<std::span<const double>> fit_readings(const signals::Dataset& dataset,
                                                  const std::string& name) {
  std::vector<std::span<const double>> out;
  for (const DatasetRecord& entry : dataset.records)
    if (entry.split == signals::Split::fit && entry.record.has(name))
      out.push_back(entry.record.channel(name));
  return out;
}

/// Smallest value over all fit records.
double quietest_deviation(const signals::Dataset& dataset, const std::string& name) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto x : fit_readings(dataset, name))
    least = std::min(least, quietest_power(spectrum_of(x)) / static_cast<double>(x.size()));
  return std::isfinite(least) ? std::sqrt(least) : 0.;
}

/// The quietest part of the acceleration; at most the usual noise where the drive leaves no part
/// quiet.
double quietest_part_of_drive(const signals::Dataset& dataset) {
  constexpr double quiet = 0.25;
  const double least = quietest_deviation(dataset, channel::base_acceleration);
  double largest = 0.;
  for (const auto x : fit_readings(dataset, channel::base_acceleration))
    largest = std::max(largest, mean_square(x));
  return least > quiet * std::sqrt(largest) ? std::min(usual_acceleration_noise, least) : least;
}

/// Quantisation noise of a 13-bit step. Smaller values occur only in simulated records, which no
/// model follows more closely.
double least_noise(const signals::Dataset& dataset, const std::string& name) {
  const double of_peak = 1. / (8192. * std::sqrt(12.));
  double peak = 0.;
  for (const auto x : fit_readings(dataset, name))
    peak = std::max({peak, std::ranges::max(x), -std::ranges::min(x)});
  return of_peak * peak;
}

}  // namespace

NoiseLines all_lines(const std::span<const double> x) {
  NoiseLines out{spectrum_of(x)};
  out.end = out.spectrum.size();
  return out;
}

NoiseLines noise_lines(const std::span<const double> reading, const double rate_hz,
                       const bool moves) {
  if (is_held(reading)) {
    NoiseLines out = all_lines(new_sample_series(reading));
    const double filled = 1. - repeat_share(reading);
    out.end = static_cast<std::size_t>(filled * static_cast<double>(out.end));
    out.of_source = true;
    out.age_range = unknown_age(reading);
    return out;
  }
  const auto even = moves ? evened_series(reading, rate_hz) : std::nullopt;
  if (!even) return all_lines(reading);
  NoiseLines out = all_lines(even->samples);
  out.of_source = true;
  out.age_range = even->unknown_age;
  return out;
}

std::size_t n_periods(const DatasetRecord& entry) {
  const std::size_t n = entry.record.n_samples(), period = entry.period_samples;
  return period > 0 && n % period == 0 ? n / period : 1;
}

ChannelNoise channel_noise(const signals::Dataset& dataset) {
  double moment = 0., acceleration = 0., n_moment = 0., n_acceleration = 0.;
  for (const DatasetRecord& entry : dataset.records) {
    if (entry.split != signals::Split::fit) continue;
    const auto add = [&](const std::string& name, const NoiseLines& lines, double& sum,
                         double& count, bool still) {
      // The part that does not repeat with the period is noise, except in the moment under wind,
      // because gusts do not repeat.
      const std::size_t step =
          name == channel::base_moment && entry.excitation.wind ? 1 : n_periods(entry);
      // Only the upper half of the spectrum, because slow drift is no sample noise.
      for (std::size_t k = lines.end / 2; k + 1 < lines.end; ++k)
        if (still || k % step != 0) {
          sum += std::norm(lines.spectrum[k]) / static_cast<double>(entry.record.n_samples());
          count += 1.;
        }
    };
    if (entry.record.has(channel::base_moment))
      add(channel::base_moment, all_lines(entry.record.channel(channel::base_moment)), moment,
          n_moment, entry.excitation == signals::Excitation{});
    if (entry.record.has(channel::base_acceleration))
      add(channel::base_acceleration,
          noise_lines(entry.record.channel(channel::base_acceleration),
                      entry.record.sampling_rate_hz(), entry.excitation.base),
          acceleration, n_acceleration, !entry.excitation.base);
  }
  const auto level = [&](const std::string& name, double sum, double n, const auto& quietest) {
    return std::max(n > 0. ? std::sqrt(sum / n) : quietest(), least_noise(dataset, name));
  };
  return {.moment_n_m = level(channel::base_moment, moment, n_moment,
                              [&] { return quietest_deviation(dataset, channel::base_moment); }),
          .acceleration_m_s2 = level(channel::base_acceleration, acceleration, n_acceleration,
                                     [&] { return quietest_part_of_drive(dataset); }),
          .acceleration_is_measured = n_acceleration > 0.};
}

}  // namespace vibrissa::diagnosis
