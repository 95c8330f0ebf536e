#include "diagnosis/localisation/gap_harmonics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "diagnosis/localisation/significance_tests.h"
#include "diagnosis/records/spectrum.h"
#include "signals/base/median.h"

namespace vibrissa::diagnosis {
namespace {

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

}  // namespace

std::string to_string(const Harmonics harmonics) {
  constexpr const char* names[] = {"none", "odd", "even", "both"};
  return names[static_cast<std::size_t>(harmonics)];
}

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

}  // namespace vibrissa::diagnosis
