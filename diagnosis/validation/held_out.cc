#include "diagnosis/validation/held_out.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/error.h"
#include "signals/base/student.h"

namespace vibrissa::diagnosis {
namespace {

/// Noise variance of a channel per sample [(N m)^2, (m/s^2)^2], and the standard deviation of the
/// logarithm of its square root.
struct NoiseLevel {
  double variance = 0., log_deviation = 0.;
};

struct NoiseLevels {
  NoiseLevel moment, acceleration;
};

NoiseLevel noise_level(const HypothesisFit& fit, const std::size_t fit_parameter) {
  const auto index = static_cast<Eigen::Index>(fit_parameter);
  return {std::exp(2. * fit.x(index)), std::sqrt(fit.covariance(index, index))};
}

/// Noise levels measured at rest, so that the error of a poor fit does not count as noise; without
/// such records as fitted. A fit that names reference_noise includes it. chain: the fit's chain.
NoiseLevels noise_levels(const Experiment& experiment, const HypothesisFit& fit,
                         const Chain& chain) {
  NoiseLevels levels{noise_level(fit, index_of_moment_noise),
                     noise_level(fit, index_of_acceleration_noise)};
  double lines = 0.;
  for (const PreparedRecord& record : experiment.records)
    if (record.excitation == signals::Excitation{})
      lines += 0.5 * static_cast<double>(record.n_bins());
    else if (record.periodic)
      lines += 0.5 * static_cast<double>(record.n_acceleration_noise);
  if (lines < 32.) return levels;
  const double deviation = 0.5 / std::sqrt(lines);
  levels.moment = {experiment.moment_noise * experiment.moment_noise, deviation};
  if (chain.reference_variance == 0.)
    levels.acceleration = {experiment.acceleration_noise * experiment.acceleration_noise,
                           deviation};
  return levels;
}

using Samples = Eigen::VectorXd;

Samples samples_of_bins(const PreparedRecord& record, const std::vector<Complex>& bins) {
  const std::vector<double> x = evaluated_samples(record, bins);
  return Eigen::Map<const Samples>(x.data(), static_cast<Eigen::Index>(x.size()));
}

/// 0, 1, 2 ...
Samples counted(const Eigen::Index n) {
  return Samples::LinSpaced(n, 0., static_cast<double>(n - 1));
}

/// Sums of squares over a part of a record [(N m)^2]: the errors, the measured moment, and the
/// unpredictable parts by the noise of both channels and by the fit's own process noise.
struct Part {
  enum : Eigen::Index { before, after, measured, moment_noise, acceleration_noise, own_noise, n };
};
using Squares = Eigen::Array<double, Part::n, 1>;

/// The unpredictable parts of one record, for one sample.
Squares floor_of(const PreparedRecord& record, const Prediction& prediction, const Chain& chain,
                 const NoiseLevels& levels) {
  const double n = static_cast<double>(record.n_evaluated), per_sample = 2. / (n * n);
  const auto sum = [&](const std::vector<double>& variance) {
    return per_sample * std::accumulate(variance.begin(), variance.end(), 0.);
  };
  const double acceleration = sum(prediction.acceleration_noise);
  Squares out = Squares::Zero();
  out(Part::moment_noise) = levels.moment.variance * sum(prediction.moment_noise);
  out(Part::acceleration_noise) = levels.acceleration.variance * acceleration;
  out(Part::own_noise) = chain.reference_variance * acceleration + sum(prediction.process_noise);
  return out;
}

/// Cosine and sine of one frequency, one column each.
Eigen::MatrixX2d wave(const Eigen::Index n, const double rate_hz, const double frequency_hz) {
  const Samples phase = 2. * std::numbers::pi * frequency_hz / rate_hz * counted(n);
  Eigen::MatrixX2d out(n, 2);
  out << phase.array().cos(), phase.array().sin();
  return out;
}

/// Subtracts the line that takes the most energy off the first half near the fitted frequency:
/// search on a grid, then by Brent's method.
void take_hum_off(Samples& error, double rate_hz, const HypothesisFit& fit) {
  constexpr int n_grid = 12, n_bits = 20;
  const auto index = fit.index("hum", 1);
  if (!index) return;
  const auto at = static_cast<Eigen::Index>(*index);
  const Samples half = error.head(error.size() / 2);
  const auto amplitudes = [&](const Eigen::MatrixX2d& columns) -> Eigen::Vector2d {
    return (columns.transpose() * columns).ldlt().solve(columns.transpose() * half);
  };
  const auto lost = [&](const double hz) {
    const Eigen::MatrixX2d columns = wave(half.size(), rate_hz, hz);
    return -half.dot(columns * amplitudes(columns));
  };
  const double half_s = static_cast<double>(half.size()) / rate_hz;
  const double step_hz = std::max(0.6 / half_s, 3. * std::sqrt(fit.covariance(at, at))) / n_grid;
  const double centre_hz = fit.fit_parameters[*index].description.value(fit.x(at));
  double near_hz = centre_hz;
  for (int i = -n_grid; i <= n_grid; ++i)
    if (const double other_hz = centre_hz + step_hz * i; lost(other_hz) < lost(near_hz))
      near_hz = other_hz;
  const double hz =
      boost::math::tools::brent_find_minima(lost, near_hz - step_hz, near_hz + step_hz, n_bits)
          .first;
  error -= wave(error.size(), rate_hz, hz) * amplitudes(wave(half.size(), rate_hz, hz));
}

/// Slope per sample of the straight line through samples.
double slope_of(const Samples& x) {
  const Samples place = (counted(x.size()).array() - 0.5 * static_cast<double>(x.size() - 1));
  return place.dot(x) / place.squaredNorm();
}

/// Subtracts a ramp when the first part of the first half predicts the rest of that half by it.
bool take_drift_off(Samples& error) {
  const Samples half = error.head(error.size() / 2), part = half.head(half.size() / 2),
                rest = half.tail(half.size() - part.size());
  const auto square = [](const Samples& x) { return (x.array() - x.mean()).square().sum(); };
  if (square(rest - slope_of(part) * counted(rest.size())) >= square(rest)) return false;
  error -= slope_of(half) * counted(error.size());
  return true;
}

double noise_floor(const Squares& sum) {
  return sum(Part::moment_noise) + sum(Part::acceleration_noise);
}

std::optional<double> gap_closed(const Squares& sum) {
  const double floor = noise_floor(sum);
  if (!(sum(Part::before) > floor)) return std::nullopt;
  return 1. - (sum(Part::after) - floor) / (sum(Part::before) - floor);
}

/// Factor by which a percentile interval is too short for few blocks: ratio of Student's to the
/// normal quantile, and the missing degree of freedom (Hesterberg 2015, expanded percentile
/// interval).
double expansion(std::size_t n_blocks) {
  const double n = static_cast<double>(n_blocks), nu = n - 1.;
  return signals::student_quantile_975(nu) / signals::normal_quantile_975 * std::sqrt(n / nu);
}

std::optional<std::array<double, 2>> interval(const std::vector<Squares>& blocks,
                                              const NoiseLevels& levels,
                                              const HeldOutOptions& options) {
  constexpr std::size_t fewest_blocks = 8;
  if (blocks.size() < fewest_blocks || options.n_resamples == 0) return std::nullopt;
  std::mt19937_64 random(options.seed);
  std::uniform_int_distribution<std::size_t> pick(0, blocks.size() - 1);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  for (std::size_t i = 0; i < options.n_resamples; ++i) {
    Squares factors = Squares::Ones(), sum = Squares::Zero();
    factors(Part::moment_noise) = std::exp(2. * levels.moment.log_deviation * normal(random));
    factors(Part::acceleration_noise) =
        std::exp(2. * levels.acceleration.log_deviation * normal(random));
    for (std::size_t j = 0; j < blocks.size(); ++j) sum += blocks[pick(random)];
    if (const auto value = gap_closed(factors * sum)) values.push_back(*value);
  }
  // No interval when many resamples have no gap.
  if (values.size() < options.n_resamples * 9 / 10) return std::nullopt;
  std::sort(values.begin(), values.end());
  const auto quantile = [&](double q) {
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  };
  const double median = quantile(0.5), factor = expansion(blocks.size());
  return std::array<double, 2>{median + factor * (quantile(0.025) - median),
                               median + factor * (quantile(0.975) - median)};
}

Squares total(const std::vector<Squares>& blocks) {
  return std::accumulate(blocks.begin(), blocks.end(), Squares(Squares::Zero()));
}

std::optional<BeforeAfter> vibration_left_db(const std::vector<Squares>& blocks) {
  const Squares sum = total(blocks);
  if (!(sum(Part::measured) > 0.)) return std::nullopt;
  const auto db = [&](double power) { return 10. * std::log10(power / sum(Part::measured)); };
  return BeforeAfter{db(sum(Part::before)), db(sum(Part::after))};
}

ErrorScore score(const std::string& name, const std::vector<Squares>& blocks,
                 const NoiseLevels& levels, const HeldOutOptions& options) {
  const Squares sum = total(blocks);
  const auto relative = [&](double square) { return std::sqrt(square / sum(Part::measured)); };
  ErrorScore out{.record = name,
                 .nrmse_before = relative(sum(Part::before)),
                 .nrmse_after = relative(sum(Part::after)),
                 .noise_floor = relative(noise_floor(sum)),
                 .irreducible_floor = relative(noise_floor(sum) + sum(Part::own_noise)),
                 .gap_closed = gap_closed(sum)};
  if (out.gap_closed) out.gap_closed_ci95 = interval(blocks, levels, options);
  return out;
}

/// series: errors before and after, and the measured moment.
std::vector<Squares> blocks_of(const PreparedRecord& record, const std::array<Samples, 3>& series,
                               std::size_t first, const Squares& floor) {
  const std::size_t longest = record.block_length(),
                    n = static_cast<std::size_t>(series.front().size());
  std::vector<Squares> blocks;
  for (std::size_t start = first; start < n; start += longest) {
    const std::size_t length = std::min(longest, n - start);
    Squares block = static_cast<double>(length) * floor;
    for (std::size_t part = 0; part < series.size(); ++part)
      block(static_cast<Eigen::Index>(part)) +=
          series[part]
              .segment(static_cast<Eigen::Index>(start), static_cast<Eigen::Index>(length))
              .squaredNorm();
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace

HeldOutScore score_held_out(const Experiment& fitted_on, const Experiment& held_out,
                            const HypothesisFit& fit, const HeldOutOptions& options) {
  if (held_out.records.empty())
    throw signals::UserError(
        "no held_out record can be compared with the simulation: give one "
        "record \"split\": \"held_out\"");
  const Chain nominal = fitted_on.nominal_chain();
  const Chain chain = fit.chain(fitted_on);
  const NoiseLevels levels = noise_levels(fitted_on, fit, chain);
  HeldOutScore out;
  for (const Effect* effect : fit.hypothesis.effects())
    if (effect->irreducible)
      (effect->id == "hum" ? out.predicted : out.not_predictable).push_back(effect->id);
  const bool halved = fit.hypothesis.contains("hum") || fit.hypothesis.contains("sensor_drift");
  bool ramp = false;
  std::vector<Squares> all, of_base;
  for (const PreparedRecord& record : held_out.records) {
    if (!record.excitation.base && !record.excitation.wind) continue;
    const Prediction prediction = simulate(chain, record);
    const std::size_t first = halved && !record.is_response() ? record.n_evaluated / 2 : 0;
    std::array<Samples, 3> series{
        samples_of_bins(record, difference(record.moment, simulate_mean(nominal, record))),
        samples_of_bins(record, difference(record.moment, prediction.mean)),
        samples_of_bins(record, record.moment)};
    Samples& after = series[Part::after];
    if (fit.hypothesis.contains("hum") && first > 0)
      take_hum_off(after, record.sampling_rate_hz, fit);
    if (fit.hypothesis.contains("sensor_drift") && first > 0) ramp |= take_drift_off(after);
    // An offset carries no information.
    if (!record.is_response())
      for (Samples& x : series)
        x.array() -= x.tail(x.size() - static_cast<Eigen::Index>(first)).mean();
    Squares floor = floor_of(record, prediction, chain, levels);
    if (out.not_predictable.empty()) floor(Part::own_noise) = 0.;
    const std::vector<Squares> blocks = blocks_of(record, series, first, floor);
    out.records.push_back(score(record.name, blocks, levels, options));
    all.insert(all.end(), blocks.begin(), blocks.end());
    if (!record.excitation.wind) of_base.insert(of_base.end(), blocks.begin(), blocks.end());
  }
  out.vibration_left_db = vibration_left_db(of_base);
  if (all.empty()) throw signals::UserError("every held_out record is at rest: nothing to score");
  if (ramp) {
    std::erase(out.not_predictable, "sensor_drift");
    out.predicted.push_back("sensor_drift");
  }
  out.overall = score("", all, levels, options);
  return out;
}

}  // namespace vibrissa::diagnosis
