#include "diagnosis/localisation/gap_in_time.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/statistics/bivariate_statistics.hpp>
#include <cmath>
#include <numeric>

#include "diagnosis/localisation/significance_tests.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

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

}  // namespace

std::vector<GapInTime> gap_in_time(const std::vector<RecordGap>& gaps) {
  std::vector<GapInTime> out;
  for (const RecordGap& gap : gaps)
    if (GapInTime along = excess_of(gap); !along.time_s.empty()) out.push_back(std::move(along));
  return out;
}

bool varies_in_time(const std::vector<RecordGap>& gaps) {
  std::vector<double> p_values;
  for (const RecordGap& gap : gaps) {
    if (kind_of(*gap.record) == "rest") continue;
    const std::vector<double> p = trend_p_values(gap);
    p_values.insert(p_values.end(), p.begin(), p.end());
  }
  const std::vector<double> corrected = holm_corrected(p_values);
  return std::any_of(corrected.begin(), corrected.end(),
                     [](double p) { return p < significant_gap; });
}

}  // namespace vibrissa::diagnosis
