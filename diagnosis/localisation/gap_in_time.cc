#include "diagnosis/localisation/gap_in_time.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "diagnosis/localisation/significance_tests.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {
namespace {

/// Two-sided p-value of the slope of a straight line through blocks in time, by Student's t
/// transformed to a normal deviate (Wallace 1959).
double trend_p_value(const std::vector<double>& y) {
  const double n = static_cast<double>(y.size()), middle = 0.5 * (n - 1.);
  const double mean = std::accumulate(y.begin(), y.end(), 0.) / n;
  double xy = 0., xx = 0., yy = 0.;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double x = static_cast<double>(i) - middle;
    xy += x * (y[i] - mean);
    xx += x * x;
    yy += (y[i] - mean) * (y[i] - mean);
  }
  const double rest = yy - xy * xy / xx, dof = n - 2.;
  if (!(rest > 0.)) return 1.;
  const double t_square = xy * xy / xx / (rest / dof);
  const double z = (8. * dof + 1.) / (8. * dof + 3.) * std::sqrt(dof * std::log1p(t_square / dof));
  return std::min(1., 2. * normal_tail(z));
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
    double pp = 0., pe = 0., qq = 0., qe = 0.;
    for (std::size_t i = from; i < to; ++i) {
      pp += p[i] * p[i];
      pe += p[i] * e[i];
      qq += q[i] * q[i];
      qe += q[i] * e[i];
    }
    if (!(pp > 0. && qq > 0.)) return {};
    gain.push_back(pe / pp);
    quadrature.push_back(qe / qq);
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
  const double square = std::inner_product(samples.begin(), samples.end(), samples.begin(), 0.);
  if (!(square > 0.)) return {};
  // Mean square of a sample when every bin contains noise alone.
  const double noise =
      square / static_cast<double>(samples.size()) * static_cast<double>(whitened.size()) / power;
  GapInTime out{.record = gap.record->name};
  for (std::size_t part = 0; part < n_parts; ++part) {
    const std::size_t from = part * samples.size() / n_parts,
                      to = (part + 1) * samples.size() / n_parts;
    double sum = 0.;
    for (std::size_t i = from; i < to; ++i) sum += samples[i] * samples[i];
    out.time_s.push_back(
        (static_cast<double>(gap.record->first) + 0.5 * static_cast<double>(from + to)) /
        gap.record->sampling_rate_hz);
    out.excess.push_back(sum / static_cast<double>(to - from) / noise);
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
