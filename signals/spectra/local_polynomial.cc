#include "signals/spectra/local_polynomial.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/spectra/channel_check.h"
#include "signals/spectra/fft.h"

namespace vibrissa::signals {

namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr double undefined_value = std::numeric_limits<double>::quiet_NaN();

// Lines 1 .. below half the sampling rate, as amplitudes. The offset is removed first, because it
// would add only rounding errors to these lines.
VectorXcd line_amplitudes(std::span<const double> x) {
  const double n = static_cast<double>(x.size());
  const double mean = std::accumulate(x.begin(), x.end(), 0.) / n;
  RealFft fft(x.size());
  std::ranges::transform(x, fft.time().begin(), [&](double value) { return value - mean; });
  fft.forward();
  VectorXcd lines(static_cast<Index>((x.size() + 1) / 2 - 1));
  for (Index k = 0; k < lines.size(); ++k)
    lines[k] = fft.spectrum()[static_cast<std::size_t>(k) + 1] * (2. / n);
  return lines;
}

struct Window {
  Index n_coefficients;  // of each polynomial
  Index width;
};

Window window_of(const LocalPolynomialOptions& options) {
  constexpr std::size_t largest_order = 8, largest_half_width = 10'000;
  if (options.order > largest_order || options.half_width > largest_half_width)
    throw UserError("local polynomial: order " + std::to_string(options.order) +
                    " with half width " + std::to_string(options.half_width) +
                    "; the order is at most 8, the half width at most 10000");
  const auto n_unknowns = static_cast<Index>(2 * (options.order + 1));
  constexpr Index freedom_wanted = 4;
  const auto half = options.half_width > 0 ? static_cast<Index>(options.half_width)
                                           : (n_unknowns + freedom_wanted) / 2;
  if (2 * half + 1 <= n_unknowns)
    throw UserError("local polynomial: " + std::to_string(2 * half + 1) + " lines for " +
                    std::to_string(n_unknowns) +
                    " unknowns leave no degree of freedom; raise half_width");
  return {n_unknowns / 2, 2 * half + 1};
}

struct Point {
  std::complex<double> value = undefined_value;
  double variance = undefined_value, noise = undefined_value, coherence = undefined_value;
};

// Fit of one window; buffers are kept from line to line.
class LocalFit {
 public:
  explicit LocalFit(const Window& window)
      : window_(window),
        matrix_(window.width, 2 * window.n_coefficients),
        scale_(2 * window.n_coefficients),
        qr_(window.width, 2 * window.n_coefficients) {}

  Point at(Index line, const VectorXcd& input, const VectorXcd& output) {
    const Index half = window_.width / 2;
    const Index first = std::clamp<Index>(line - half, 0, input.size() - window_.width);
    fill(line, first, input);
    if (!(scale_.minCoeff() > 0.)) return {};
    qr_.compute(matrix_);
    if (qr_.rank() < matrix_.cols()) return {};
    const auto y = output.segment(first, window_.width);
    VectorXcd turned = qr_.householderQ().adjoint() * y;
    const Index n = matrix_.cols();
    Point point;
    point.noise =
        turned.tail(window_.width - n).squaredNorm() / static_cast<double>(window_.width - n);
    const auto r = qr_.matrixR().topLeftCorner(n, n).triangularView<Eigen::Upper>();
    const VectorXcd solution = qr_.colsPermutation() * r.solve(turned.head(n));
    // Row of the pseudo-inverse that belongs to the response at the line itself.
    const VectorXcd unit = qr_.colsPermutation().transpose() * VectorXcd::Unit(n, 0);
    const VectorXcd row = r.adjoint().solve(unit);
    point.value = solution[0] / scale_[0];
    point.variance = point.noise * row.squaredNorm() / (scale_[0] * scale_[0]);
    // Noise adds its variance to the squared magnitude.
    const double explained = std::max(0., std::norm(point.value) - point.variance) *
                             input.segment(first, window_.width).squaredNorm() /
                             static_cast<double>(window_.width);
    point.coherence = explained > 0. ? explained / (explained + point.noise) : 0.;
    return point;
  }

 private:
  // Columns: U r^s, then r^s, each of unit length, r in half widths from the line.
  void fill(Index line, Index first, const VectorXcd& input) {
    const double half = 0.5 * static_cast<double>(window_.width - 1);
    for (Index i = 0; i < window_.width; ++i) {
      const double r = static_cast<double>(first + i - line) / half;
      double power = 1.;
      for (Index s = 0; s < window_.n_coefficients; ++s, power *= r) {
        matrix_(i, s) = power * input[first + i];
        matrix_(i, window_.n_coefficients + s) = power;
      }
    }
    for (Index c = 0; c < matrix_.cols(); ++c) {
      scale_[c] = matrix_.col(c).norm();
      if (scale_[c] > 0.) matrix_.col(c) /= scale_[c];
    }
  }

  Window window_;
  MatrixXcd matrix_;
  Eigen::VectorXd scale_;
  Eigen::ColPivHouseholderQR<MatrixXcd> qr_;
};

}  // namespace

LocalPolynomialResponse local_polynomial_response(std::span<const double> input,
                                                  std::span<const double> output,
                                                  double sampling_rate_hz,
                                                  const LocalPolynomialOptions& options) {
  check_channels("local polynomial", input, output, sampling_rate_hz);
  const Window window = window_of(options);
  if (input.size() < static_cast<std::size_t>(2 * window.width + 2))
    throw UserError("local polynomial: " + std::to_string(input.size()) +
                    " samples have fewer lines than the window of " + std::to_string(window.width) +
                    "; take a longer record");
  const VectorXcd u = line_amplitudes(input), y = line_amplitudes(output);
  LocalFit fit(window);
  LocalPolynomialResponse result;
  for (Index line = 0; line < u.size(); ++line) {
    const Point point = fit.at(line, u, y);
    result.response.frequency_hz.push_back(static_cast<double>(line + 1) * sampling_rate_hz /
                                           static_cast<double>(input.size()));
    result.response.value.push_back(point.value);
    result.response.standard_deviation.push_back(std::sqrt(point.variance));
    result.response.coherence.push_back(point.coherence);
    result.noise_variance.push_back(point.noise);
  }
  return result;
}

}  // namespace vibrissa::signals
