#include "diagnosis/search/fisher_changes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "diagnosis/prediction/chain_simulation.h"

namespace vibrissa::diagnosis {

NoisyChain noisy_chain(const Experiment& experiment,
                       const std::vector<FitParameter>& fit_parameters, const Eigen::VectorXd& x,
                       const Effect* left_out) {
  return {make_chain(experiment, fit_parameters, x, left_out),
          std::exp(2. * x(index_of_moment_noise)), std::exp(2. * x(index_of_acceleration_noise))};
}

FisherChanges::FisherChanges(const Experiment& experiment, std::vector<double> deviation,
                             const NoisyChain& reference)
    : experiment_(experiment), deviation_(std::move(deviation)) {
  mean_.resize(2 * static_cast<Eigen::Index>(deviation_.size()));
  noise_.resize(static_cast<Eigen::Index>(deviation_.size()));
  evaluate(reference, mean_, noise_);
  at_rest_ = at_rest(reference.acceleration_variance + reference.chain.reference_variance);
}

Eigen::VectorXd FisherChanges::of(const NoisyChain& moved) const {
  Eigen::VectorXd mean(mean_.size()), noise(noise_.size());
  Eigen::VectorXd out(mean_.size() + noise_.size() + at_rest_.size());
  evaluate(moved, mean, noise);
  out.head(mean.size()) = mean - mean_;
  // The rest of the variance (misfit, model form error) is that of the reference.
  out.segment(mean.size(), noise.size()) =
      (noise - noise_).array().max(-0.999).log1p() * std::sqrt(0.5);
  out.tail(at_rest_.size()) =
      at_rest(moved.acceleration_variance + moved.chain.reference_variance) - at_rest_;
  return out;
}

double FisherChanges::beyond_square(const Eigen::VectorXd& change) const {
  const auto log_ratio = change.segment(mean_.size(), noise_.size()).array() * std::sqrt(2.);
  return (log_ratio.exp() - 1. - log_ratio - 0.5 * log_ratio.square()).sum();
}

Eigen::VectorXd FisherChanges::at_rest(const double acceleration_variance) const {
  std::vector<double> out;
  for (const PreparedRecord& record : experiment_.records)
    if (record.n_acceleration_noise > 0)
      out.push_back(std::sqrt(0.5 * static_cast<double>(record.n_acceleration_noise)) *
                    std::log(acceleration_variance));
  return Eigen::Map<const Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

void FisherChanges::evaluate(const NoisyChain& state, Eigen::VectorXd& mean,
                             Eigen::VectorXd& noise) const {
  const double acceleration = state.acceleration_variance + state.chain.reference_variance;
  Eigen::Index row = 0;
  for (const Prediction& there : ChainSimulator(state.chain).predict(experiment_.records)) {
    for (std::size_t b = 0; b < there.mean.size(); ++b, ++row) {
      const double deviation = deviation_[static_cast<std::size_t>(row)];
      mean(2 * row) = there.mean[b].real() / deviation;
      mean(2 * row + 1) = there.mean[b].imag() / deviation;
      noise(row) = (state.moment_variance * there.moment_noise[b] +
                    acceleration * there.acceleration_noise[b] + there.process_noise[b]) /
                   (deviation * deviation);
    }
  }
}

double half_prior(const FitParameter& fit_parameter, const double x, const double n_spreads) {
  return 0.5 * fit_parameter.description.prior.curvature(x) / (n_spreads * n_spreads);
}

FisherDirections::FisherDirections(const std::vector<Eigen::VectorXd>& columns,
                                   const std::vector<double>& half_priors) {
  if (columns.empty()) return;
  columns_.resize(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i)
    columns_.col(static_cast<Eigen::Index>(i)) = columns[i];
  overlap_ = columns_.transpose() * columns_;
  gram_ = overlap_;
  for (std::size_t i = 0; i < half_priors.size(); ++i)
    gram_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += half_priors[i];
}

double FisherDirections::left(const Eigen::VectorXd& change,
                              const std::vector<bool>& chosen) const {
  return left(change.squaredNorm(), columns_.transpose() * change, chosen);
}

double FisherDirections::left_of(const Eigen::Index column, const double energy,
                                 const std::vector<bool>& chosen) const {
  const double own = overlap_(column, column);
  if (!(own > 0.)) return 0.;
  return left(energy, std::sqrt(energy / own) * overlap_.col(column), chosen);
}

double FisherDirections::left(const double whole, const Eigen::VectorXd& overlap,
                              const std::vector<bool>& chosen) const {
  std::vector<Eigen::Index> indices;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i] && gram_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) > 0.)
      indices.push_back(static_cast<Eigen::Index>(i));
  if (indices.empty()) return whole;
  const Eigen::VectorXd right = overlap(indices);
  const Eigen::MatrixXd matrix = gram_(indices, indices);
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  const Eigen::VectorXd along = solver.eigenvectors().transpose() * (scale.asDiagonal() * right);
  // Directions that differ only by rounding count once.
  constexpr double same = 1e-11;
  double explained = 0.;
  for (Eigen::Index i = 0; i < along.size(); ++i)
    if (solver.eigenvalues()(i) > same) explained += along(i) * along(i) / solver.eigenvalues()(i);
  return std::max(0., whole - explained);
}

}  // namespace vibrissa::diagnosis
