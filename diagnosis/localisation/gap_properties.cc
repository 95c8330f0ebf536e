#include "diagnosis/localisation/location.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/statistics/bivariate_statistics.hpp>
#include <cmath>
#include <numeric>
#include <optional>

#include "diagnosis/localisation/significance_tests.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/median.h"

namespace vibrissa::diagnosis {
namespace {

/// Relative gap at the excited lines of one record, minus noise, and the level of its motion.
struct LevelPoint {
  double log_level = 0., log_gap = 0., variance = 0.;
};

std::optional<LevelPoint> level_point(const RecordGap& gap) {
  const PreparedRecord& record = *gap.record;
  double level = 0., error = 0., noise = 0., noise_square = 0., measured = 0.;
  for (std::size_t b = 0; b < gap.error.size(); ++b) {
    const double a = std::norm(record.acceleration[record.whole_line(b)]);
    if (a == 0.) continue;
    level += a;
    error += std::norm(gap.error[b]);
    noise += gap.variance[b];
    noise_square += gap.variance[b] * (gap.variance[b] + 2. * std::norm(gap.error[b]));
    measured += std::norm(record.moment[b]);
  }
  const double square = error - noise;
  if (!(square > 3. * std::sqrt(noise_square)) || level == 0.) return std::nullopt;
  return LevelPoint{0.5 * std::log(level) - std::log(static_cast<double>(record.n_samples)),
                    0.5 * std::log(square / measured), 0.25 * noise_square / (square * square)};
}

/// Are the excited lines so far above the accelerometer's noise that none was misclassified as not
/// excited?
bool every_line_stands_out(const PreparedRecord& record) {
  std::vector<double> shares;
  for (std::size_t k = 1; k < record.acceleration.size(); ++k)
    if (std::norm(record.acceleration[k]) > 0.) shares.push_back(record.noise_share[k]);
  constexpr double clear_share = 0.97;
  return !shares.empty() && signals::median(std::move(shares)) > clear_share;
}

/// p-values of the lines that a multisine does not excite, [0] odd and [1] even multiples of its
/// base frequency, against the noise between the lines of its period.
std::array<double, 2> parity_p_values(const RecordGap& gap, const RestNoise& rest) {
  const PreparedRecord& record = *gap.record;
  std::size_t step = 0, first = 0;
  for (std::size_t k = 1; k < record.acceleration.size(); ++k)
    if (std::norm(record.acceleration[k]) > 0.) {
      step = std::gcd(step, k);
      if (first == 0) first = k;
    }
  if (step < 2 || !every_line_stands_out(record)) return {1., 1.};
  std::vector<double> between(gap.error.size(), 0.), counted(gap.error.size(), 0.);
  for (std::size_t b = 0; b < gap.error.size(); ++b)
    if ((b + 1) % step != 0) {
      between[b] = std::norm(gap.error[b]);
      counted[b] = 1.;
    }
  constexpr std::size_t reach = 15;
  const std::vector<double> noise = neighbour_mean(between, reach),
                            share = neighbour_mean(counted, reach);
  std::array<double, 2> sum{}, n{};
  for (std::size_t k = std::max(step, first / 2 / step * step); k <= gap.error.size(); k += step) {
    if (std::norm(record.acceleration[k]) > 0. || on_rest_line(rest, record, k - 1)) continue;
    const std::size_t parity = (k / step) % 2 == 0 ? 1 : 0;
    // The inverse of the mean of m exponential variates is too large by m / (m - 1).
    const double m = share[k - 1] * (2. * reach + 1.);
    sum[parity] += std::norm(gap.error[k - 1]) * share[k - 1] / noise[k - 1] * (m - 1.) / m;
    n[parity] += 1.;
  }
  const double n_between = 2. * std::accumulate(counted.begin(), counted.end(), 0.);
  std::array<double, 2> p{1., 1.};
  for (std::size_t i = 0; i < 2; ++i)
    // A ratio to the mean of about 15 neighbours scatters more than the line itself.
    if (n[i] > 0.) p[i] = variance_ratio_tail(sum[i] / n[i], 2. * n[i] / 1.2, n_between);
  return p;
}

/// Two-sided p-value of the slope of a straight line through blocks in time, by Student's t.
double trend_p_value(const std::vector<double>& y) {
  std::vector<double> x(y.size());
  std::iota(x.begin(), x.end(), 0.);
  const double r = boost::math::statistics::correlation_coefficient(x, y),
               dof = static_cast<double>(y.size()) - 2.;
  if (!(std::abs(r) < 1.)) return 1.;
  const boost::math::students_t distribution(dof);
  return 2. * boost::math::cdf(boost::math::complement(
                  distribution, std::abs(r) * std::sqrt(dof / (1. - r * r))));
}

/// In-phase and quadrature gain of the measured moment relative to the predicted one, for each
/// block in time.
std::vector<double> trend_p_values(const RecordGap& gap) {
  constexpr std::size_t n_blocks = 16;
  std::vector<Complex> turned(gap.predicted);
  for (Complex& value : turned) value *= Complex(0., -1.);
  const std::vector<double> p = evaluated_samples(*gap.record, gap.predicted);
  const std::vector<double> q = evaluated_samples(*gap.record, turned);
  const std::vector<double> e = evaluated_samples(*gap.record, gap.error);
  std::vector<double> gain, quadrature;
  for (std::size_t block = 0; block < n_blocks; ++block) {
    const std::size_t from = block * e.size() / n_blocks, to = (block + 1) * e.size() / n_blocks;
    const auto part = [&](const std::vector<double>& x) {
      return Eigen::Map<const Eigen::VectorXd>(x.data() + from,
                                               static_cast<Eigen::Index>(to - from));
    };
    const double pp = part(p).squaredNorm(), qq = part(q).squaredNorm();
    if (!(pp > 0. && qq > 0.)) return {};
    gain.push_back(part(p).dot(part(e)) / pp);
    quadrature.push_back(part(q).dot(part(e)) / qq);
  }
  return {trend_p_value(gain), trend_p_value(quadrature)};
}

GapInTime excess_of(const RecordGap& gap) {
  constexpr std::size_t n_parts = 24;
  std::vector<Complex> whitened(gap.error);
  double power = 0.;
  for (std::size_t b = 0; b < whitened.size(); ++b) {
    whitened[b] /= std::sqrt(gap.variance[b]);
    power += std::norm(whitened[b]);
  }
  const std::vector<double> samples = evaluated_samples(*gap.record, whitened);
  if (!(power > 0.)) return {};
  // Mean square of a sample when every bin contains noise alone.
  const double noise = mean_square(samples) * static_cast<double>(whitened.size()) / power;
  GapInTime out{.record = gap.record->name};
  for (std::size_t part = 0; part < n_parts; ++part) {
    const std::size_t from = part * samples.size() / n_parts,
                      to = (part + 1) * samples.size() / n_parts;
    out.time_s.push_back(
        (static_cast<double>(gap.record->first) + 0.5 * static_cast<double>(from + to)) /
        gap.record->sampling_rate_hz);
    out.excess.push_back(mean_square(std::span(samples).subspan(from, to - from)) / noise);
  }
  return out;
}

/// From the excited lines of periodic base records, minus noise; nothing when there is one level
/// only or no gap under base motion.
std::optional<LevelExponent> level_exponent(const std::vector<RecordGap>& gaps) {
  std::vector<LevelPoint> points;
  for (const RecordGap& gap : gaps)
    if (kind_of(*gap.record) == "base" && gap.record->is_steady())
      if (const auto point = level_point(gap)) points.push_back(*point);
  if (points.size() < 2) return std::nullopt;
  const auto [low, high] = std::ranges::minmax(points, {}, &LevelPoint::log_level);
  constexpr double least_ratio = 1.3;
  if (high.log_level - low.log_level < std::log(least_ratio)) return std::nullopt;
  // Scatter of the relative gap in addition to noise, because lines and phases differ between
  // records.
  constexpr double scatter = 0.05;
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixX2d line(n, 2);  // weighted: 1 and the level
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const LevelPoint& point = points[static_cast<std::size_t>(i)];
    const double weight = 1. / std::sqrt(point.variance + scatter * scatter);
    line.row(i) << weight, weight * point.log_level;
    right(i) = weight * point.log_gap;
  }
  const Eigen::Matrix2d covariance = (line.transpose() * line).inverse();
  const double slope = (covariance * (line.transpose() * right))(1);
  const double deviation = std::sqrt(covariance(1, 1));
  return LevelExponent{std::abs(slope) > 2. * deviation ? slope : 0., deviation};
}

/// Distortion at the lines that the multisines of base records do not excite, by parity.
Harmonics harmonics_of(const std::vector<RecordGap>& gaps, const RestNoise& rest) {
  std::vector<double> p_values;
  for (const RecordGap& gap : gaps) {
    if (kind_of(*gap.record) != "base" || !gap.record->periodic) continue;
    const std::array<double, 2> p = parity_p_values(gap, rest);
    p_values.insert(p_values.end(), p.begin(), p.end());
  }
  const std::vector<double> corrected = holm_corrected(p_values);
  bool odd = false, even = false;
  for (std::size_t i = 0; i < corrected.size(); ++i)
    (i % 2 == 0 ? odd : even) |= corrected[i] < 0.1 * significant_gap;
  if (odd && even) return Harmonics::both;
  if (odd) return Harmonics::odd;
  return even ? Harmonics::even : Harmonics::none;
}

/// The error along every record with an excitation.
std::vector<GapInTime> gap_in_time(const std::vector<RecordGap>& gaps) {
  std::vector<GapInTime> out;
  for (const RecordGap& gap : gaps) {
    if (gap.record->is_response()) continue;
    if (GapInTime along = excess_of(gap); !along.time_s.empty()) out.push_back(std::move(along));
  }
  return out;
}

/// Does gain or phase of the measured moment relative to the predicted one have a trend anywhere?
bool varies_in_time(const std::vector<RecordGap>& gaps) {
  std::vector<double> p_values;
  for (const RecordGap& gap : gaps) {
    if (kind_of(*gap.record) == "rest" || gap.record->is_response()) continue;
    const std::vector<double> p = trend_p_values(gap);
    p_values.insert(p_values.end(), p.begin(), p.end());
  }
  return !p_values.empty() && std::ranges::min(holm_corrected(p_values)) < significant_gap;
}

}  // namespace

std::string to_string(const Harmonics harmonics) {
  constexpr const char* names[] = {"none", "odd", "even", "both"};
  return names[static_cast<std::size_t>(harmonics)];
}

void set_properties(const std::vector<RecordGap>& gaps, const RestNoise& rest, Location& out) {
  out.level_exponent = level_exponent(gaps);
  out.harmonics = harmonics_of(gaps, rest);
  out.varies_in_time = varies_in_time(gaps);
  out.in_time = gap_in_time(gaps);
}

}  // namespace vibrissa::diagnosis
