#include "checks/drive_facts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "diagnosis/model/words.h"
#include "diagnosis/records/spectrum.h"
#include "separation/segments/hit_blocks.h"
#include "signals/spectra/fft.h"
#include "signals/spectra/resample.h"

namespace vibrissa::checks {
namespace {

using diagnosis::FindingKind;
using diagnosis::three_digits;
namespace channel = signals::channel;

/// Correlation coefficients at the lags up to half the record.
std::vector<double> autocorrelation(std::span<const double> values) {
  const std::vector<double> x = signals::remove_mean(values);
  const std::size_t n = x.size();
  signals::RealFft fft(2 * n);
  std::fill(fft.time().begin(), fft.time().end(), 0.);
  std::copy(x.begin(), x.end(), fft.time().begin());
  fft.forward();
  for (auto& line : fft.spectrum()) line = std::norm(line);
  fft.inverse();
  std::vector<double> square{0.};
  for (const double v : x) square.push_back(square.back() + v * v);
  std::vector<double> out(n / 2 + 1);
  for (std::size_t lag = 0; lag < out.size(); ++lag) {
    const double both = square[n - lag] * (square[n] - square[lag]);
    out[lag] = both > 0. ? fft.time()[lag] / std::sqrt(both) : 0.;
  }
  return out;
}

std::size_t period_of(std::span<const double> x) {
  const std::vector<double> r = autocorrelation(x);
  constexpr double repeats = 0.9;
  // A slow signal resembles itself a little later: the first maximum is behind the first zero.
  const auto begin = std::find_if(r.begin(), r.end(), [](double v) { return v < 0.; });
  if (begin == r.end()) return 0;
  const double largest = *std::max_element(begin, r.end());
  if (largest < repeats) return 0;
  // Noise in both periods lowers the correlation; its deviation is (1 - r^2) / sqrt(n).
  const double tolerance = 3. * (1. - largest * largest) / std::sqrt(double(x.size()) / 2.) + 1e-9;
  auto found = std::find_if(begin, r.end(), [&](double v) { return v > largest - tolerance; });
  while (found + 1 != r.end() && *(found + 1) > *found) ++found;
  return std::size_t(found - r.begin());
}

/// The sample after which the variance is below a tenth.
std::optional<std::size_t> end_of_drive(std::span<const double> values) {
  constexpr std::size_t n_parts = 48;
  constexpr double quiet = 0.1;
  const std::size_t length = values.size() / n_parts;
  if (length == 0) return std::nullopt;
  const std::vector<double> x = signals::remove_mean(values.last(length));
  const double rest = values.back() - x.back();  // mean of the end
  std::vector<double> power(n_parts, 0.);
  for (std::size_t p = 0; p < n_parts; ++p)
    for (const double v : values.subspan(p * length, length))
      power[p] += (v - rest) * (v - rest) / double(length);
  const double all = std::accumulate(power.begin(), power.end(), 0.);
  const double least = 1e-18 * all;
  double tail = 0., best = 0.;
  std::optional<std::size_t> end;
  for (std::size_t p = n_parts - 1; p > 0; --p) {
    tail += power[p];
    const double behind = std::max(tail / double(n_parts - p), least),
                 before = (all - tail) / double(p);
    if (!(behind < quiet * before)) continue;
    const double gain = double(n_parts) * std::log(all / double(n_parts)) -
                        double(n_parts - p) * std::log(behind) - double(p) * std::log(before);
    if (gain > best) {
      best = gain;
      end = p * length;
    }
  }
  return end;
}

}  // namespace

DriveFacts drive_facts(const signals::Record& record) {
  DriveFacts drive;
  const auto x = record.channel(channel::base_acceleration);
  const std::size_t third = x.size() / 3;
  for (std::size_t i = 0; i < 3; ++i)
    drive.level_m_s2[i] = diagnosis::rms_about_mean(x.subspan(i * third, third));
  drive.n_hits = separation::hits_of(x).size();
  if (drive.n_hits > 0) {
    drive.kind = DriveKind::hits;
    return drive;
  }
  drive.period_samples = period_of(x);
  drive.kind = drive.period_samples > 0 ? DriveKind::periodic : DriveKind::random_or_other;
  if (const auto end = end_of_drive(x)) drive.end_s = record.time_s(*end);
  return drive;
}

void find_drive_faults(const signals::Record& record, const DriveFacts& drive,
                       std::vector<Finding>& findings) {
  const std::string& name = channel::base_acceleration;
  if (drive.n_hits == 1)
    findings.push_back({FindingKind::one_hit, name, 1., "1",
                        "the record has one hit: nothing is left to score the model, and the "
                        "scatter between hits is unknown; record at least five hits",
                        Severity::limits});
  if (!drive.end_s) return;
  const double rest_s = record.time_s(0) + record.duration_s() - *drive.end_s;
  // More than half of the last third, which scores a model.
  if (rest_s < record.duration_s() / 6.) return;
  const auto rows =
      std::size_t(std::lround((*drive.end_s - record.time_s(0)) * record.sampling_rate_hz()));
  findings.push_back(
      {FindingKind::drive_ended, name, *drive.end_s, "s",
       "the drive ended at " + three_digits(*drive.end_s) + " s, and the base rests for the last " +
           three_digits(rest_s) +
           " s, which score the model; use the part before (--rows 1:" + std::to_string(rows) + ")",
       Severity::limits});
}

}  // namespace vibrissa::checks
