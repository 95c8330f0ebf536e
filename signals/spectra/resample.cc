#include "signals/spectra/resample.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/spectra/kaiser_sinc.h"

namespace vibrissa::signals {
namespace {

constexpr long largest_term = 1000;
// Rates from printed times have rounding errors; this tolerance is a drift of one sample in 1e9.
constexpr double ratio_tolerance = 1e-9;

// up / down of the rates, in lowest terms.
struct Ratio {
  long up, down;
};

double value_of(const Ratio& ratio) {
  return static_cast<double>(ratio.up) / static_cast<double>(ratio.down);
}

// The last convergent of the continued fraction of x whose terms both stay within largest_term.
Ratio nearest_ratio(const double x) {
  Ratio before{0, 1}, current{1, 0};
  double rest = x;
  for (;;) {
    const double whole = std::floor(rest);
    if (whole > static_cast<double>(largest_term)) return current;
    const auto a = static_cast<long>(whole);
    const Ratio next{a * current.up + before.up, a * current.down + before.down};
    if (next.up > largest_term || next.down > largest_term) return current;
    before = current;
    current = next;
    const double fraction = rest - whole;
    if (std::abs(value_of(current) / x - 1.) <= ratio_tolerance || fraction <= 0.) return current;
    rest = 1. / fraction;
  }
}

Ratio ratio_of_rates(const double from_hz, const double to_hz) {
  for (const double rate : {from_hz, to_hz})
    if (!(std::isfinite(rate) && rate > 0.))
      throw UserError("resampling: a rate must be a positive number of Hz, not " + to_text(rate));
  const Ratio ratio = nearest_ratio(to_hz / from_hz);
  if (ratio.up == 0 || ratio.down == 0 ||
      std::abs(value_of(ratio) * from_hz / to_hz - 1.) > ratio_tolerance)
    throw UserError("resampling from " + to_text(from_hz) + " Hz to " + to_text(to_hz) +
                    " Hz: the ratio of the rates is not a ratio of whole numbers up to " +
                    std::to_string(largest_term) + "; choose another rate");
  return ratio;
}

// Low pass between a share and the whole of the lower Nyquist frequency; length and shape by
// Kaiser's formulas. Times are in samples of the input.
KaiserSinc low_pass(const Ratio& ratio, const double flat_to_share) {
  constexpr double attenuation_db = 90.;
  const double lower_nyquist = 0.5 * std::min(1., value_of(ratio));
  const double transition_rad = 2. * std::numbers::pi * (1. - flat_to_share) * lower_nyquist;
  return {.cut_off = 0.5 * (1. + flat_to_share) * lower_nyquist,
          .half_length = 0.5 * (attenuation_db - 7.95) / (2.285 * transition_rad),
          .shape = 0.1102 * (attenuation_db - 8.7)};
}

// Column p weighs the input samples -reach ... reach around floor(t) for an output at t, where
// t - floor(t) = p / up. Each column sums to one: a constant comes out as it is.
Eigen::MatrixXd polyphase_weights(const Ratio& ratio, const KaiserSinc& kernel, const long reach) {
  Eigen::MatrixXd weights(2 * reach + 1, ratio.up);
  for (long p = 0; p < ratio.up; ++p) {
    const double fraction = static_cast<double>(p) / static_cast<double>(ratio.up);
    for (long k = -reach; k <= reach; ++k)
      weights(k + reach, p) = kernel(static_cast<double>(k) - fraction);
    weights.col(p) /= weights.col(p).sum();
  }
  return weights;
}

// The ends are extended by reflecting the record in its first and last point, alternately, so that
// a record shorter than the reach is reflected as often as needed.
Eigen::VectorXd extended(const std::span<const double> x, const long reach) {
  const auto n = static_cast<long>(x.size());
  Eigen::VectorXd result = Eigen::VectorXd::Constant(n + 2 * reach, x.front());
  const auto at = [&](const long i) -> double& { return result[reach + i]; };
  for (long i = 0; i < n; ++i) at(i) = x[static_cast<std::size_t>(i)];
  for (long k = 1; k <= reach; ++k) {
    at(-k) = 2. * x.front() - at(k);
    at(n - 1 + k) = 2. * x.back() - at(n - 1 - k);
  }
  return result;
}

double mean_of(const std::span<const double> x) {
  return std::accumulate(x.begin(), x.end(), 0.) / static_cast<double>(x.size());
}

}  // namespace

std::vector<double> resample(const std::span<const double> x, const double from_hz,
                             const double to_hz, const double flat_to_share) {
  if (!(flat_to_share > 0. && flat_to_share < 1.))
    throw UserError("resampling: a flat band up to " + to_text(flat_to_share) +
                    " of half the sampling rate is not possible; give a share between 0 and 1");
  const Ratio ratio = ratio_of_rates(from_hz, to_hz);
  if (x.empty() || (ratio.up == 1 && ratio.down == 1)) return {x.begin(), x.end()};
  const KaiserSinc kernel = low_pass(ratio, flat_to_share);
  const auto reach = static_cast<long>(std::ceil(kernel.half_length));
  const Eigen::MatrixXd weights = polyphase_weights(ratio, kernel, reach);
  const Eigen::VectorXd input = extended(x, reach);
  const long n_output = (static_cast<long>(x.size()) * ratio.up + ratio.down - 1) / ratio.down;
  std::vector<double> output(static_cast<std::size_t>(n_output));
  for (long j = 0; j < n_output; ++j) {
    const long before = j * ratio.down / ratio.up, phase = j * ratio.down % ratio.up;
    output[static_cast<std::size_t>(j)] =
        weights.col(phase).dot(input.segment(before, 2 * reach + 1));
  }
  return output;
}

std::vector<double> remove_mean(const std::span<const double> x) {
  std::vector<double> result(x.begin(), x.end());
  if (x.empty()) return result;
  // The second mean removes the rounding error of the first mean, which is large for a large
  // offset.
  for (int pass = 0; pass < 2; ++pass) {
    const double mean = mean_of(result);
    for (double& value : result) value -= mean;
  }
  return result;
}

std::vector<double> scale_to_range(const std::span<const double> x, const double low,
                                   const double high) {
  if (!std::all_of(x.begin(), x.end(), [](const double value) { return std::isfinite(value); }))
    throw UserError("scaling to a range: the values must be finite");
  if (x.empty()) throw UserError("scaling to a range: there are no values");
  const auto [smallest, largest] = std::minmax_element(x.begin(), x.end());
  if (*smallest == *largest)
    throw UserError("scaling to a range: all values are " + to_text(*smallest) +
                    ", so they cannot be scaled");
  std::vector<double> result(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    result[i] = std::lerp(low, high, (x[i] - *smallest) / (*largest - *smallest));
  return result;
}

}  // namespace vibrissa::signals
