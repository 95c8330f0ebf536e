#include "diagnosis/prediction/record_nuisances.h"

#include <Eigen/Cholesky>
#include <cassert>
#include <cmath>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

std::vector<const RecordNuisance*> those_there(const std::span<const RecordNuisance> unknowns) {
  std::vector<const RecordNuisance*> out;
  for (const RecordNuisance& unknown : unknowns)
    if (unknown.variance > 0.) out.push_back(&unknown);
  return out;
}

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

IntegratedNuisances::IntegratedNuisances(const std::span<const RecordNuisance> unknowns,
                                         const std::span<const Complex> error,
                                         const std::span<const double> variance)
    : there_(those_there(unknowns)) {
  const auto n = static_cast<Eigen::Index>(there_.size());
  if (n == 0) return;
  shapes_.resize(2 * static_cast<Eigen::Index>(variance.size()), n);
  for (Eigen::Index i = 0; i < n; ++i)
    shapes_.col(i) = whitened(there_[static_cast<std::size_t>(i)]->shape, variance);
  Eigen::VectorXd deviation(n);
  for (Eigen::Index i = 0; i < n; ++i)
    deviation(i) = std::sqrt(there_[static_cast<std::size_t>(i)]->variance);
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
  if (there_.empty()) return 0.;
  return 0.5 * score_.dot(covariance_ * score_) - 0.5 * log_determinant_;
}

void IntegratedNuisances::remove_from(const std::span<Complex> error) const {
  if (there_.empty()) return;
  const Eigen::VectorXd values = mean();
  for (std::size_t i = 0; i < there_.size(); ++i)
    for (std::size_t b = 0; b < error.size(); ++b)
      error[b] -= values(static_cast<Eigen::Index>(i)) * there_[i]->shape[b];
}

}  // namespace vibrissa::diagnosis
