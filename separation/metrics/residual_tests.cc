#include "separation/metrics/residual_tests.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <sstream>

#include "signals/base/error.h"
#include "signals/base/is_constant.h"
#include "signals/spectra/fft.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

// Signal without its mean and scaled to unit mean square, with zeros appended so that no lag wraps
// around.
class Normalised {
 public:
  Normalised(std::span<const double> x, std::size_t length, const std::string& name)
      : fft_(length) {
    double mean = 0., square = 0.;
    for (const double value : x) mean += value / static_cast<double>(x.size());
    for (const double value : x) square += (value - mean) * (value - mean);
    if (!std::isfinite(square))
      throw UserError("residual tests: the " + name + " has values that are not finite");
    if (signals::is_constant(x)) throw UserError("residual tests: the " + name + " is constant");
    auto time = fft_.time();
    std::ranges::fill(time, 0.);
    for (std::size_t i = 0; i < x.size(); ++i) time[i] = (x[i] - mean) / std::sqrt(square);
    fft_.forward();
    spectrum_.assign(fft_.spectrum().begin(), fft_.spectrum().end());
  }

  // sum_n x[n + l] y[n] at index l, negative lags at the end.
  std::vector<double> correlation(const Normalised& y) {
    auto product = fft_.spectrum();
    for (std::size_t k = 0; k < product.size(); ++k)
      product[k] = spectrum_[k] * std::conj(y.spectrum_[k]);
    fft_.inverse();
    return {fft_.time().begin(), fft_.time().end()};
  }

 private:
  signals::RealFft fft_;
  std::vector<std::complex<double>> spectrum_;
};

// Two-sided quantile of the normal distribution, by bisection of its tail.
double normal_limit(double outside) {
  double low = 0., high = 40.;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::numbers::sqrt2) > outside ? low : high) = middle;
  }
  return high;
}

void set_limits(Correlation& correlation, double deviation, double false_alarm) {
  const auto n_lags = static_cast<double>(correlation.lag.size());
  const double each = -std::expm1(std::log1p(-false_alarm) / n_lags);
  correlation.single_limit = normal_limit(0.01) * deviation;
  correlation.all_limit = normal_limit(each) * deviation;
  for (std::size_t i = 0; i < correlation.lag.size(); ++i)
    if (std::abs(correlation.value[i]) > correlation.all_limit)
      correlation.suspicious_lags.push_back(correlation.lag[i]);
}

// "3..5, 9".
std::string ranges(const std::vector<int>& lags) {
  std::ostringstream text;
  for (std::size_t i = 0; i < lags.size();) {
    std::size_t last = i;
    while (last + 1 < lags.size() && lags[last + 1] == lags[last] + 1) ++last;
    text << (i ? ", " : "") << lags[i];
    if (last > i) text << ".." << lags[last];
    i = last + 1;
  }
  return text.str();
}

std::string whiteness_words(const Correlation& c) {
  if (c.passed()) return "the residual is white";
  return "the residual is not white (lags " + ranges(c.suspicious_lags) +
         "): possible causes are wind, accelerometer noise that passes through the model, or "
         "dynamics that the model does not contain";
}

std::string independence_words(const Correlation& c) {
  if (c.passed()) return "the residual is uncorrelated with the input";
  std::vector<int> before, after;
  for (const int lag : c.suspicious_lags) (lag < 0 ? before : after).push_back(lag);
  std::string text;
  if (!after.empty())
    text = "the residual is correlated with the input at lags " + ranges(after) +
           ": the order is too low, the hold is wrong, or the sensor is nonlinear";
  if (!before.empty())
    text += (after.empty() ? "" : "; ") +
            std::string("the residual is correlated with later input at lags ") + ranges(before) +
            ": the output feeds back to the input, a delay is wrong, or the hold is wrong";
  return text;
}

}  // namespace

ResidualTests test_residual(std::span<const double> residual,
                            std::span<const double> base_acceleration,
                            const ResidualTestOptions& options) {
  const std::size_t n = residual.size();
  if (base_acceleration.size() != n)
    throw UserError("residual tests: " + std::to_string(n) + " samples of residual, but " +
                    std::to_string(base_acceleration.size()) + " of base acceleration");
  if (options.max_lag == 0 || n < samples_per_lag * options.max_lag)
    throw UserError("residual tests: " + std::to_string(n) +
                    " samples are too few for lags up to " + std::to_string(options.max_lag) +
                    " (at least " + std::to_string(samples_per_lag) +
                    " for each lag, and at least one lag)");
  if (!(options.false_alarm > 0. && options.false_alarm < 1.))
    throw UserError("residual tests: false_alarm must lie between 0 and 1");
  const auto memory = static_cast<std::size_t>(std::sqrt(static_cast<double>(n)));
  const std::size_t length = std::bit_ceil(n + std::max(memory, options.max_lag) + 1);
  Normalised e(residual, length, "residual"), u(base_acceleration, length, "base acceleration");
  const std::vector<double> ee = e.correlation(e), uu = u.correlation(u), eu = e.correlation(u);

  ResidualTests result;
  const auto max_lag = static_cast<int>(options.max_lag);
  for (int lag = 1; lag <= max_lag; ++lag) {
    result.whiteness.lag.push_back(lag);
    result.whiteness.value.push_back(ee[static_cast<std::size_t>(lag)]);
  }
  for (int lag = -max_lag; lag <= max_lag; ++lag) {
    result.independence.lag.push_back(lag);
    result.independence.value.push_back(
        eu[lag < 0 ? length - static_cast<std::size_t>(-lag) : static_cast<std::size_t>(lag)]);
  }
  double variance = 1.;
  for (std::size_t k = 1; k <= memory; ++k)
    variance +=
        2. * (1. - static_cast<double>(k) / static_cast<double>(memory + 1)) * ee[k] * uu[k];
  const auto samples = static_cast<double>(n);
  set_limits(result.whiteness, std::sqrt(1. / samples), options.false_alarm);
  set_limits(result.independence, std::sqrt(std::max(variance, 1. / samples) / samples),
             options.false_alarm);
  result.whiteness.words = whiteness_words(result.whiteness);
  result.independence.words = independence_words(result.independence);
  result.words = result.whiteness.words + "; " + result.independence.words;
  return result;
}

}  // namespace vibrissa::separation
