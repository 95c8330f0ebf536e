#include "diagnosis/prediction/record_nuisances.h"

#include <Eigen/Cholesky>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

/// Divided by the bins' standard deviations, real and imaginary parts in turn.
Eigen::VectorXd whitened(const std::span<const Complex> values,
                         const std::span<const double> variance) {
  assert(values.size() == variance.size());
  Eigen::VectorXd out(2 * static_cast<Eigen::Index>(values.size()));
  for (std::size_t b = 0; b < values.size(); ++b) {
    const Complex value = values[b] / std::sqrt(variance[b]);
    out(2 * static_cast<Eigen::Index>(b)) = value.real();
    out(2 * static_cast<Eigen::Index>(b) + 1) = value.imag();
  }
  return out;
}

}  // namespace

RecordNuisance unknown_ramp(const double variance, const std::size_t n_samples,
                            const std::size_t n_bins) {
  RecordNuisance out{variance, std::vector<Complex>(n_bins)};
  for (std::size_t b = 0; b < n_bins; ++b) {
    const double angle =
        2. * std::numbers::pi * static_cast<double>(b + 1) / static_cast<double>(n_samples);
    out.shape[b] = 1. / (std::exp(Complex(0., -angle)) - 1.);
  }
  return out;
}

std::array<RecordNuisance, 2> unknown_wave(const double variance, const Complex pole_per_sample,
                                           const std::size_t n_samples, const std::size_t n_bins) {
  constexpr double on_a_bin = 1e-9;  // above the rounding of the products
  const double n = static_cast<double>(n_samples);
  std::array<RecordNuisance, 2> out{RecordNuisance{variance, std::vector<Complex>(n_bins)},
                                    RecordNuisance{variance, std::vector<Complex>(n_bins)}};
  const Complex step = std::exp(pole_per_sample), back = std::conj(step),
                rest = 1. - std::exp(n * pole_per_sample), back_rest = std::conj(rest),
                bin = std::polar(1., -2. * std::numbers::pi / n);
  const auto sum = [n](const Complex& whole, const Complex& per_step) {
    const Complex gap = 1. - per_step;
    return std::norm(gap) < on_a_bin * on_a_bin ? Complex(n) : whole / gap;
  };
  Complex turn = 1.;
  for (std::size_t b = 0; b < n_bins; ++b) {
    turn *= bin;
    const Complex forth = sum(rest, step * turn), conjugate = sum(back_rest, back * turn);
    out[0].shape[b] = 0.5 * (forth + conjugate);
    out[1].shape[b] = Complex(0., -0.5) * (forth - conjugate);
  }
  return out;
}

IntegratedNuisances::IntegratedNuisances(const std::span<const RecordNuisance> unknowns,
                                         const std::span<const Complex> error,
                                         const std::span<const double> variance)
    : unknowns_(unknowns), n_rows_(2 * std::ssize(variance)) {
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  if (n == 0) return;
  shapes_.resize(n_rows_, n);
  Eigen::VectorXd deviation(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const RecordNuisance& unknown = unknowns[static_cast<std::size_t>(i)];
    shapes_.col(i) = whitened(unknown.shape, variance);
    deviation(i) = std::sqrt(unknown.variance);
  }
  // Parameters are scaled by their standard deviations, because their sizes differ.
  const Eigen::MatrixXd scaled = shapes_ * deviation.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> llt(Eigen::MatrixXd::Identity(n, n) +
                                        2. * scaled.transpose() * scaled);
  covariance_ =
      deviation.asDiagonal() * llt.solve(Eigen::MatrixXd::Identity(n, n)) * deviation.asDiagonal();
  score_ = 2. * shapes_.transpose() * whitened(error, variance);
  log_determinant_ = 2. * Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum();
}

double IntegratedNuisances::log_likelihood_gain() const {
  if (!any()) return 0.;
  return 0.5 * score_.dot(covariance_ * score_) - 0.5 * log_determinant_;
}

void IntegratedNuisances::remove_from(const std::span<Complex> error) const {
  if (!any()) return;
  const Eigen::VectorXd values = mean();
  for (std::size_t i = 0; i < unknowns_.size(); ++i)
    for (std::size_t b = 0; b < error.size(); ++b)
      error[b] -= values(static_cast<Eigen::Index>(i)) * unknowns_[i].shape[b];
}

std::vector<Complex> IntegratedNuisances::change_to(
    const std::span<const RecordNuisance> moved) const {
  assert(moved.size() == unknowns_.size());
  const Eigen::VectorXd values = mean();
  std::vector<Complex> out(unknowns_.front().shape.size(), 0.);
  for (std::size_t i = 0; i < unknowns_.size(); ++i)
    for (std::size_t b = 0; b < out.size(); ++b)
      out[b] += values(static_cast<Eigen::Index>(i)) * (moved[i].shape[b] - unknowns_[i].shape[b]);
  return out;
}

Eigen::VectorXd IntegratedNuisances::slope_of_variance() const {
  Eigen::VectorXd out = mean().cwiseAbs2() - variances() + covariance_.diagonal();
  return 0.5 * out.cwiseQuotient(variances().cwiseMax(std::numeric_limits<double>::min()));
}

Eigen::VectorXd IntegratedNuisances::determined_share() const {
  return (variances() - covariance_.diagonal())
      .cwiseQuotient(variances().cwiseMax(std::numeric_limits<double>::min()));
}

Eigen::VectorXd IntegratedNuisances::variances() const {
  Eigen::VectorXd out(std::ssize(unknowns_));
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out(i) = unknowns_[static_cast<std::size_t>(i)].variance;
  return out;
}

}  // namespace vibrissa::diagnosis
