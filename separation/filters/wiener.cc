#include "separation/filters/wiener.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "separation/filters/spectra_buffer.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/spectra/fft.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

void check_signal(std::span<const double> x, const std::string& name) {
  const auto bad = std::ranges::find_if_not(x, [](double value) { return std::isfinite(value); });
  if (bad != x.end())
    throw UserError("Wiener filter: " + name + " is not finite at sample " +
                    std::to_string(bad - x.begin()) + "; remove or replace this sample");
}

void check(std::span<const double> a, std::span<const double> m, const WienerOptions& options) {
  if (a.size() != m.size())
    throw UserError("Wiener filter: " + std::to_string(a.size()) +
                    " samples of acceleration, but " + std::to_string(m.size()) +
                    " samples of moment");
  if (options.filter_length == 0 || options.filter_length > a.size())
    throw UserError("Wiener filter: filter_length = " + std::to_string(options.filter_length) +
                    " must be between 1 and the number of samples, " + std::to_string(a.size()));
  if (!(options.regularisation >= 0. && std::isfinite(options.regularisation)))
    throw UserError("Wiener filter: regularisation = " + signals::to_text(options.regularisation) +
                    " must be finite and not negative");
  check_signal(a, signals::channel::base_acceleration);
  check_signal(m, signals::channel::base_moment);
}

// Lengths of two, three and five are quick.
std::size_t quick_length(std::size_t at_least) {
  for (std::size_t n = at_least;; ++n) {
    std::size_t rest = n;
    for (const std::size_t factor : {2u, 3u, 5u})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return n;
  }
}

/// Products with the matrix of delayed accelerations and its transpose.
class DelayMatrix {
 public:
  DelayMatrix(std::span<const double> a, std::size_t n_taps)
      : n_samples_(a.size()), n_taps_(n_taps), fft_(quick_length(a.size() + n_taps)) {
    const double power = Eigen::Map<const Eigen::ArrayXd>(a.data(), rows()).square().mean();
    if (power > 0.) scale_ = 1. / std::sqrt(power);
    load(Eigen::Map<const Eigen::VectorXd>(a.data(), rows()));
    time() *= scale_;
    fft_.forward();
    spectrum_ = spectrum();
  }

  /// What the accelerations are multiplied by, so that their mean square is one.
  double scale() const { return scale_; }
  Eigen::Index rows() const { return static_cast<Eigen::Index>(n_samples_); }
  Eigen::Index cols() const { return static_cast<Eigen::Index>(n_taps_); }

  Eigen::VectorXd filter(const Eigen::VectorXd& taps) {
    load(taps);
    fft_.forward();
    spectrum() *= spectrum_;
    fft_.inverse();
    return time().head(rows());
  }
  Eigen::VectorXd correlate(const Eigen::VectorXd& samples) {
    load(samples);
    fft_.forward();
    spectrum() *= spectrum_.conjugate();
    fft_.inverse();
    return time().head(cols());
  }
  /// Sum over the record of a[i] a[i + lag], lag 0 .. n_taps - 1.
  Eigen::ArrayXd autocorrelation() {
    spectrum() = spectrum_.abs2();
    fft_.inverse();
    return time().head(cols());
  }

 private:
  void load(const Eigen::Ref<const Eigen::VectorXd>& x) {
    time().head(x.size()) = x;
    time().tail(time().size() - x.size()).setZero();
  }
  Eigen::Map<Eigen::ArrayXd> time() {
    return {fft_.time().data(), static_cast<Eigen::Index>(fft_.size())};
  }
  Eigen::Map<Spectrum> spectrum() {
    return {fft_.spectrum().data(), static_cast<Eigen::Index>(fft_.n_bins())};
  }

  std::size_t n_samples_, n_taps_;
  signals::RealFft fft_;
  Spectrum spectrum_;
  double scale_ = 1.;
};

/// Solves with the circulant nearest to the Toeplitz matrix of an autocorrelation.
class CirculantSolver {
 public:
  CirculantSolver(const Eigen::ArrayXd& correlation, double ridge)
      : fft_(static_cast<std::size_t>(correlation.size())) {
    const Eigen::Index n = correlation.size();
    Eigen::Map<Eigen::ArrayXd> time(fft_.time().data(), n);
    time[0] = correlation[0];
    for (Eigen::Index k = 1; k < n; ++k)
      time[k] = (static_cast<double>(n - k) * correlation[k] +
                 static_cast<double>(k) * correlation[n - k]) /
                static_cast<double>(n);
    fft_.forward();
    const Eigen::ArrayXd eigenvalues = spectrum().real();
    // The record's ends make the smallest eigenvalues of the circulant too small.
    inverse_ = (eigenvalues.max(1e-6 * eigenvalues.maxCoeff()) + ridge).inverse();
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& x) {
    Eigen::Map<Eigen::VectorXd> time(fft_.time().data(), x.size());
    time = x;
    fft_.forward();
    spectrum() *= inverse_;
    fft_.inverse();
    return time;
  }

 private:
  Eigen::Map<Spectrum> spectrum() {
    return {fft_.spectrum().data(), static_cast<Eigen::Index>(fft_.n_bins())};
  }
  signals::RealFft fft_;
  Eigen::ArrayXd inverse_;
};

struct Solution {
  Eigen::VectorXd taps;
  double relative_gradient = 0.;
  int n_iterations = 0;
};

Solution conjugate_gradients(DelayMatrix& matrix, const Eigen::VectorXd& moment, double ridge) {
  CirculantSolver preconditioner(matrix.autocorrelation(), ridge);
  Solution solution{.taps = Eigen::VectorXd::Zero(matrix.cols())};
  Eigen::VectorXd gradient = matrix.correlate(moment);
  const double start = gradient.norm();
  if (start == 0.) return solution;
  Eigen::VectorXd direction = preconditioner.solve(gradient);
  double product = gradient.dot(direction);
  constexpr int most_iterations = 2000;
  constexpr double near_enough = 1e-10;
  while (solution.n_iterations < most_iterations && gradient.norm() > near_enough * start) {
    const Eigen::VectorXd image = matrix.correlate(matrix.filter(direction)) + ridge * direction;
    const double length = product / direction.dot(image);
    solution.taps += length * direction;
    gradient -= length * image;
    const Eigen::VectorXd better = preconditioner.solve(gradient);
    const double next = gradient.dot(better);
    direction = better + next / product * direction;
    product = next;
    ++solution.n_iterations;
  }
  solution.relative_gradient = gradient.norm() / start;
  return solution;
}

}  // namespace

WienerResult wiener_filter(std::span<const double> base_acceleration,
                           std::span<const double> base_moment, const WienerOptions& options) {
  check(base_acceleration, base_moment, options);
  DelayMatrix matrix(base_acceleration, options.filter_length);
  Eigen::VectorXd moment = Eigen::Map<const Eigen::VectorXd>(base_moment.data(), matrix.rows());
  const double largest = moment.cwiseAbs().maxCoeff();
  const double moment_scale = largest > 0. ? largest : 1.;
  moment /= moment_scale;
  const double ridge = options.regularisation * static_cast<double>(base_moment.size());
  const Solution solution = conjugate_gradients(matrix, moment, ridge);
  const Eigen::VectorXd wind = moment_scale * (moment - matrix.filter(solution.taps));
  const Eigen::VectorXd taps = moment_scale * matrix.scale() * solution.taps;
  return {.taps = {taps.begin(), taps.end()},
          .wind_moment = {wind.begin(), wind.end()},
          .relative_gradient = solution.relative_gradient,
          .n_iterations = solution.n_iterations};
}

WienerResult wiener_filter(const signals::Record& record, const WienerOptions& options) {
  return wiener_filter(record.channel(signals::channel::base_acceleration),
                       record.channel(signals::channel::base_moment), options);
}

}  // namespace vibrissa::separation
