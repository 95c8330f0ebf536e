#include "diagnosis/localisation/record_gap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "diagnosis/localisation/significance_tests.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/median.h"

namespace vibrissa::diagnosis {
namespace {

/// Power of white noise from the median of the upper half of the spectrum, which contains no slow
/// drift.
double white_power(const std::vector<double>& power) {
  const auto middle = power.begin() + static_cast<std::ptrdiff_t>(power.size() / 2);
  return signals::median({middle, power.end()}) / std::numbers::ln2;
}

}  // namespace

std::string kind_of(const PreparedRecord& record) {
  if (record.excitation.base && record.excitation.wind) return "product";
  if (record.excitation.base) return "base";
  return record.excitation.wind ? "wind" : "rest";
}

double base_level_m_s2(const PreparedRecord& record) {
  return std::sqrt(2. * total_power(record.acceleration)) / static_cast<double>(record.n_samples);
}

RestNoise rest_noise(const Experiment& experiment) {
  RestNoise out;
  for (const PreparedRecord& record : experiment.records) {
    if (kind_of(record) != "rest") continue;
    std::vector<double> power = powers(record.moment);
    const double white = white_power(power);
    for (double& p : power) p /= white;
    std::vector<double> tests;
    std::vector<std::size_t> line_bins;
    const double n = static_cast<double>(power.size());
    for (std::size_t b = 0; b < power.size(); ++b)
      if (n * std::exp(-power[b]) < 0.1 * significant_gap) line_bins.push_back(b);
    tests.push_back(std::clamp(n * std::exp(-std::ranges::max(power)), 1e-300, 1.));
    for (std::size_t low = 0; low + fewest_band_bins <= power.size();
         low = 2 * low + fewest_band_bins) {
      const std::size_t high = std::min(power.size(), 2 * low + fewest_band_bins);
      const std::span<const double> band = std::span(power).subspan(low, high - low);
      const double size = static_cast<double>(band.size());
      tests.push_back(
          variance_ratio_tail(std::reduce(band.begin(), band.end()) / size, 2. * size, 0.5 * n));
    }
    const double p = std::ranges::min(holm_corrected(tests));
    if (p >= out.p_value) continue;
    out.p_value = p;
    out.coloured = p < significant_gap;
    out.bin_hz = record.bin_hz();
    out.excess = neighbour_mean(power, 3);
    out.lines_hz.clear();
    for (const std::size_t b : line_bins) out.lines_hz.push_back(record.frequency_hz(b));
  }
  return out;
}

RecordGap gap_of(const Experiment& experiment, const PreparedRecord& record,
                 const RestNoise& rest) {
  const Prediction prediction = simulate(experiment.nominal_chain(), record);
  RecordGap gap{
      .record = &record, .predicted = prediction.mean, .error = record.moment, .variance = {}};
  const double misfit =
      record.excitation.wind ? experiment.nominal.wind_misfit : experiment.nominal.base_misfit;
  const std::vector<double> level = neighbour_mean(powers(prediction.mean), 10);
  const double moment = experiment.moment_noise * experiment.moment_noise;
  const double acceleration = experiment.acceleration_noise * experiment.acceleration_noise;
  for (std::size_t b = 0; b < gap.error.size(); ++b) {
    gap.error[b] -= prediction.mean[b];
    double own = moment * prediction.moment_noise[b];
    if (rest.coloured) {
      const auto bin = static_cast<std::size_t>(std::lround(record.frequency_hz(b) / rest.bin_hz));
      own *= std::max(1., rest.excess[std::clamp<std::size_t>(bin, 1, rest.excess.size()) - 1]);
    }
    gap.variance.push_back(own + acceleration * prediction.acceleration_noise[b] +
                           misfit * misfit * level[b]);
  }
  return gap;
}

bool on_rest_line(const RestNoise& rest, const PreparedRecord& record, std::size_t b) {
  const double f = record.frequency_hz(b);
  return std::ranges::any_of(rest.lines_hz, [&](double line) {
    return std::abs(f - line) < 3. * std::max(rest.bin_hz, record.bin_hz());
  });
}

}  // namespace vibrissa::diagnosis
