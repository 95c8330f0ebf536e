#include "signals/base/power_law.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/student.h"

namespace vibrissa::signals {

namespace {

void check(const std::span<const double> x, const std::span<const double> y) {
  assert(x.size() == y.size());
  if (x.size() < 3)
    throw UserError("a power law needs at least three points, got " + std::to_string(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > (i == 0 ? 0. : x[i - 1])) || !std::isfinite(x[i]))
      throw UserError("a power law needs positive, ascending values; value " +
                      std::to_string(i + 1) + " is " + to_text(x[i]));
    if (y[i] == 0. || !std::isfinite(y[i]))
      throw UserError("a power law needs finite responses other than zero; the response to " +
                      to_text(x[i]) + " is " + to_text(y[i]));
  }
}

}  // namespace

PowerLaw fit_power_law(const std::span<const double> x, const std::span<const double> y) {
  check(x, y);
  const auto n = static_cast<double>(x.size());
  std::vector<double> a, b;
  double mean_a = 0., mean_b = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) {
    a.push_back(std::log(x[i]));
    b.push_back(std::log(std::abs(y[i])));
    mean_a += a[i] / n;
    mean_b += b[i] / n;
  }
  double aa = 0., ab = 0.;
  PowerLaw law;
  law.lowest_local_exponent = std::numeric_limits<double>::infinity();
  law.highest_local_exponent = -law.lowest_local_exponent;
  for (std::size_t i = 0; i < x.size(); ++i) {
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    if (i == 0) continue;
    const double local = (b[i] - b[i - 1]) / (a[i] - a[i - 1]);
    law.lowest_local_exponent = std::min(law.lowest_local_exponent, local);
    law.highest_local_exponent = std::max(law.highest_local_exponent, local);
  }
  law.exponent = ab / aa;
  law.factor = std::exp(mean_b - law.exponent * mean_a);
  double left = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double e = b[i] - mean_b - law.exponent * (a[i] - mean_a);
    left += e * e;
  }
  law.half_interval_95 = student_quantile_975(n - 2.) * std::sqrt(left / ((n - 2.) * aa));
  return law;
}

}  // namespace vibrissa::signals
