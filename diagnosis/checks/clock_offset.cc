#include "diagnosis/checks/data_checks.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/model/words.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

namespace channel = signals::channel;

/// Cross spectrum of unit magnitude at the lines where both signals are strong.
std::vector<Complex> phase_transform(const NominalModel& nominal,
                                     const signals::DatasetRecord& entry) {
  constexpr double weak = 0.05;
  const std::vector<Complex> a = spectrum_of(entry.record.channel(channel::base_acceleration)),
                             m = spectrum_of(entry.record.channel(channel::base_moment)),
                             predicted = passed(
                                 a, entry.record.n_samples(), entry.record.sampling_rate_hz(),
                                 [&](Complex s) { return nominal.base_response(s); });
  const double power = total_power(a) / static_cast<double>(a.size());
  std::vector<Complex> out(a.size(), 0.);
  for (std::size_t k = 1; k + 1 < a.size(); ++k) {
    if (std::norm(a[k]) < weak * power) continue;
    const Complex cross = m[k] * std::conj(predicted[k]);
    if (std::abs(cross) > 0.) out[k] = cross / std::abs(cross);
  }
  return out;
}

signals::DatasetRecord shifted(const signals::DatasetRecord& entry, const std::ptrdiff_t offset) {
  signals::DatasetRecord out = entry;
  const auto moment = entry.record.channel(channel::base_moment);
  const auto n = static_cast<std::ptrdiff_t>(moment.size());
  std::vector<double> turned(moment.begin(), moment.end());
  std::rotate(turned.begin(), turned.begin() + (offset % n + n) % n, turned.end());
  out.record.set_channel(channel::base_moment, std::move(turned));
  if (entry.period_samples > 0) return out;
  const auto cut = static_cast<std::size_t>(std::abs(offset));
  out.record = out.record.slice(offset < 0 ? cut : 0, moment.size() - cut);
  return out;
}

std::string message_for(const double offset_s) {
  return "base_moment_N_m is " + three_digits(std::abs(offset_s)) + " s " +
         (offset_s > 0. ? "later" : "earlier") +
         " than base_acceleration_m_s2 of the same row: the two channels have two clocks; the "
         "moment was shifted back before anything was fitted";
}

}  // namespace

std::optional<std::ptrdiff_t> clock_offset(const NominalModel& nominal,
                                           const signals::DatasetRecord& entry) {
  const std::size_t n = entry.record.n_samples();
  if (!nominal.has_base || !entry.excitation.base || n < 16 ||
      !entry.record.has(channel::base_acceleration))
    return std::nullopt;
  const std::vector<Complex> lines = phase_transform(nominal, entry);
  const double n_lines = total_power(lines);  // each of unit magnitude or zero
  const std::vector<double> peaks = samples_of(lines, n);
  const auto best = std::ranges::max_element(peaks, {}, [](double x) { return std::abs(x); });
  // Share of the lines that agree on one delay; that of lines of random phase is the square root of
  // ln n / lines.
  constexpr double least_share = 0.25, n_deviations = 1.5;
  const double share = std::abs(*best) * static_cast<double>(n) / (2. * n_lines);
  const double by_chance = std::sqrt(std::log(static_cast<double>(n)) / n_lines);
  if (!(share > std::max(least_share, n_deviations * by_chance))) return std::nullopt;
  // A nonlinear sensor spreads the peak; then the records are aligned if it is nearly as large
  // where one measuring chain has it.
  constexpr double clearly = 2.;
  const auto reach =
      std::min(n / 2, static_cast<std::size_t>(longest_delay_s * entry.record.sampling_rate_hz()));
  double nearby = 0.;
  for (std::size_t i = 0; i <= reach; ++i)
    nearby = std::max({nearby, std::abs(peaks[i]), std::abs(peaks[(n - i) % n])});
  const auto index = static_cast<std::ptrdiff_t>(best - peaks.begin());
  if (std::abs(*best) < clearly * nearby) return 0;
  return 2 * index > static_cast<std::ptrdiff_t>(n) ? index - static_cast<std::ptrdiff_t>(n)
                                                    : index;
}

AlignedDataset align_clocks(const NominalModel& nominal, const signals::Dataset& dataset) {
  AlignedDataset out{.dataset = dataset};
  for (signals::DatasetRecord& entry : out.dataset.records) {
    const auto offset = clock_offset(nominal, entry);
    if (!offset) continue;
    const double offset_s = static_cast<double>(*offset) / entry.record.sampling_rate_hz();
    if (std::abs(offset_s) <= longest_delay_s) continue;
    out.findings.push_back({FindingKind::two_clocks, entry.name, message_for(offset_s)});
    entry = shifted(entry, *offset);
  }
  return out;
}

}  // namespace vibrissa::diagnosis
