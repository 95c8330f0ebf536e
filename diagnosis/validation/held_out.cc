#include "diagnosis/validation/held_out.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "diagnosis/fit/noise_levels.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/error.h"
#include "signals/base/student.h"

namespace vibrissa::diagnosis {
namespace {

using Samples = std::vector<double>;

/// Mean squares [(N m)^2] of the unpredictable parts of one record.
struct FloorParts {
  double moment = 0., acceleration = 0., own = 0.;
};

FloorParts floor_parts(const PreparedRecord& record, const Prediction& prediction,
                       const Chain& chain, double moment_variance, double acceleration_variance) {
  FloorParts parts;
  const double n = static_cast<double>(record.n_evaluated);
  for (std::size_t b = 0; b < record.n_bins(); ++b) {
    const double acceleration = prediction.acceleration_noise[b] * 2. / (n * n);
    parts.moment += moment_variance * prediction.moment_noise[b] * 2. / (n * n);
    parts.acceleration += acceleration_variance * acceleration;
    parts.own +=
        chain.reference_variance * acceleration + prediction.process_noise[b] * 2. / (n * n);
  }
  return parts;
}

/// Sine and cosine fitted to the first half at one frequency.
struct Line {
  double frequency_hz = 0., cosine = 0., sine = 0., energy = 0.;
};

Line line_at(std::span<const double> error, double rate_hz, double frequency_hz) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  const double w = 2. * std::numbers::pi * frequency_hz / rate_hz;
  for (std::size_t i = 0; i < error.size(); ++i) {
    const double phase = w * static_cast<double>(i);
    const Eigen::Vector2d row(std::cos(phase), std::sin(phase));
    normal += row * row.transpose();
    right += row * error[i];
  }
  const Eigen::Vector2d solution = normal.ldlt().solve(right);
  return {frequency_hz, solution(0), solution(1), right.dot(solution)};
}

/// The line with the most energy near a frequency: search on a grid, then with halved steps.
Line strongest_line(std::span<const double> error, double rate_hz, double centre_hz,
                    double reach_hz) {
  constexpr int n_grid = 12, n_halvings = 10;
  Line best = line_at(error, rate_hz, centre_hz);
  const auto consider = [&](double frequency_hz) {
    const Line line = line_at(error, rate_hz, frequency_hz);
    if (line.energy > best.energy) best = line;
  };
  for (int i = -n_grid; i <= n_grid; ++i) consider(centre_hz + reach_hz * i / n_grid);
  double step = reach_hz / n_grid;
  for (int i = 0; i < n_halvings; ++i) {
    step *= 0.5;
    const double middle = best.frequency_hz;
    consider(middle - step);
    consider(middle + step);
  }
  return best;
}

void take_hum_off(Samples& error, double rate_hz, const HypothesisFit& fit) {
  const std::size_t half = error.size() / 2;
  const auto index = fit.index("hum", 1);
  if (!index) return;
  const auto at = static_cast<Eigen::Index>(*index);
  const double half_s = static_cast<double>(half) / rate_hz;
  const double reach_hz = std::max(0.6 / half_s, 3. * std::sqrt(fit.covariance(at, at)));
  const double centre_hz = fit.fit_parameters[*index].description.value(fit.x(at));
  const Line line = strongest_line(std::span(error).first(half), rate_hz, centre_hz, reach_hz);
  const double w = 2. * std::numbers::pi * line.frequency_hz / rate_hz;
  for (std::size_t i = 0; i < error.size(); ++i) {
    const double phase = w * static_cast<double>(i);
    error[i] -= line.cosine * std::cos(phase) + line.sine * std::sin(phase);
  }
}

/// Slope per sample of the straight line through samples.
double slope_of(std::span<const double> x) {
  const double n = static_cast<double>(x.size()), middle = 0.5 * (n - 1.);
  double sum = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (static_cast<double>(i) - middle) * x[i];
  return 12. * sum / (n * n * n);
}

double square_about_mean(std::span<const double> x, double slope) {
  double sum = 0., square = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double value = x[i] - slope * static_cast<double>(i);
    sum += value;
    square += value * value;
  }
  return square - sum * sum / static_cast<double>(x.size());
}

/// Subtracts a ramp when the first part of the first half predicts the rest of that half by it.
bool take_drift_off(Samples& error) {
  const std::span<const double> half = std::span(error).first(error.size() / 2);
  const std::span<const double> part = half.first(half.size() / 2);
  const std::span<const double> rest = half.subspan(part.size());
  if (square_about_mean(rest, slope_of(part)) >= square_about_mean(rest, 0.)) return false;
  const double slope = slope_of(half);
  for (std::size_t i = 0; i < error.size(); ++i) error[i] -= slope * static_cast<double>(i);
  return true;
}

/// Subtracts the mean of the evaluated part, because an offset carries no information.
void take_mean_off(Samples& x, std::size_t first) {
  double mean = 0.;
  for (std::size_t i = first; i < x.size(); ++i)
    mean += x[i] / static_cast<double>(x.size() - first);
  for (double& value : x) value -= mean;
}

/// Sums over one block in time.
struct Block {
  double before = 0., after = 0., measured = 0.;
  FloorParts floor{};
};

void add(Block& sum, const Block& b, double moment_factor = 1., double acceleration_factor = 1.) {
  sum.before += b.before;
  sum.after += b.after;
  sum.measured += b.measured;
  sum.floor.moment += moment_factor * b.floor.moment;
  sum.floor.acceleration += acceleration_factor * b.floor.acceleration;
  sum.floor.own += b.floor.own;
}

Block total(const std::vector<Block>& blocks) {
  Block sum;
  for (const Block& block : blocks) add(sum, block);
  return sum;
}

std::optional<double> gap_closed(const Block& sum) {
  const double floor = sum.floor.moment + sum.floor.acceleration;
  if (!(sum.before > floor)) return std::nullopt;
  return 1. - (sum.after - floor) / (sum.before - floor);
}

/// Factor by which a percentile interval is too short for few blocks: ratio of Student's to the
/// normal quantile, and the missing degree of freedom (Hesterberg 2015, expanded percentile
/// interval).
double expansion(std::size_t n_blocks) {
  const double n = static_cast<double>(n_blocks), nu = n - 1.;
  return signals::student_quantile_975(nu) / signals::normal_quantile_975 * std::sqrt(n / nu);
}

std::optional<std::array<double, 2>> interval(const std::vector<Block>& blocks,
                                              const NoiseLevels& levels,
                                              const HeldOutOptions& options) {
  constexpr std::size_t fewest_blocks = 8;
  if (blocks.size() < fewest_blocks || options.n_resamples == 0) return std::nullopt;
  std::mt19937_64 random(options.seed);
  std::uniform_int_distribution<std::size_t> pick(0, blocks.size() - 1);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  for (std::size_t i = 0; i < options.n_resamples; ++i) {
    const double moment = std::exp(2. * levels.moment.log_deviation * normal(random));
    const double acceleration = std::exp(2. * levels.acceleration.log_deviation * normal(random));
    Block sum;
    for (std::size_t j = 0; j < blocks.size(); ++j)
      add(sum, blocks[pick(random)], moment, acceleration);
    if (const auto value = gap_closed(sum)) values.push_back(*value);
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

std::optional<BeforeAfter> vibration_left_db(const std::vector<Block>& blocks) {
  const Block sum = total(blocks);
  if (!(sum.measured > 0.)) return std::nullopt;
  const auto db = [&](double power) { return 10. * std::log10(power / sum.measured); };
  return BeforeAfter{db(sum.before), db(sum.after)};
}

ErrorScore score(const std::string& name, const std::vector<Block>& blocks,
                 const NoiseLevels& levels, const HeldOutOptions& options) {
  const Block sum = total(blocks);
  const double floor = sum.floor.moment + sum.floor.acceleration;
  const auto relative = [&](double square) { return std::sqrt(square / sum.measured); };
  ErrorScore out{.record = name,
                 .nrmse_before = relative(sum.before),
                 .nrmse_after = relative(sum.after),
                 .noise_floor = relative(floor),
                 .irreducible_floor = relative(floor + sum.floor.own),
                 .gap_closed = gap_closed(sum)};
  if (out.gap_closed) out.gap_closed_ci95 = interval(blocks, levels, options);
  return out;
}

std::vector<Block> blocks_of(const PreparedRecord& record, const Samples& before,
                             const Samples& after, const Samples& measured, std::size_t first,
                             const FloorParts& floor) {
  constexpr double block_s = 0.25;
  const auto length = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::lround(block_s * record.sampling_rate_hz)));
  std::vector<Block> blocks;
  for (std::size_t start = first; start < before.size(); start += length) {
    const std::size_t end = std::min(before.size(), start + length);
    const double n = static_cast<double>(end - start);
    Block block{.floor = {n * floor.moment, n * floor.acceleration, n * floor.own}};
    for (std::size_t i = start; i < end; ++i) {
      block.before += before[i] * before[i];
      block.after += after[i] * after[i];
      block.measured += measured[i] * measured[i];
    }
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
  std::vector<Block> all, of_base;
  for (const PreparedRecord& record : held_out.records) {
    if (!record.excitation.base && !record.excitation.wind) continue;
    const Prediction prediction = simulate(chain, record);
    const std::size_t first = halved ? record.n_evaluated / 2 : 0;
    Samples before =
        evaluated_samples(record, difference(record.moment, simulate_mean(nominal, record)));
    Samples after = evaluated_samples(record, difference(record.moment, prediction.mean));
    Samples measured = evaluated_samples(record, record.moment);
    if (fit.hypothesis.contains("hum")) take_hum_off(after, record.sampling_rate_hz, fit);
    if (fit.hypothesis.contains("sensor_drift")) ramp |= take_drift_off(after);
    for (Samples* x : {&before, &after, &measured}) take_mean_off(*x, first);
    FloorParts floor = floor_parts(record, prediction, chain, levels.moment.variance,
                                   levels.acceleration.variance);
    if (out.not_predictable.empty()) floor.own = 0.;
    const std::vector<Block> blocks = blocks_of(record, before, after, measured, first, floor);
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
