#include "diagnosis/planning/reference_point.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "diagnosis/fit/fit_posterior.h"

namespace vibrissa::diagnosis {
namespace {

ReferencePoint nominal_point(const Experiment& experiment, const ChannelNoise& noise) {
  std::vector<FitParameter> fit_parameters = make_fit_parameters(experiment, Hypothesis{});
  Eigen::VectorXd x(static_cast<Eigen::Index>(fit_parameters.size()));
  std::ranges::transform(fit_parameters, x.begin(), [](const FitParameter& parameter) {
    return parameter.description.prior.centre;
  });
  x(index_of_moment_noise) = std::log(noise.moment_n_m);
  x(index_of_acceleration_noise) = std::log(noise.acceleration_m_s2);
  // The limits are those by noise alone.
  x(index_of_incoherence) = fit_parameters[index_of_incoherence].description.prior.low;
  FitPosterior posterior(experiment, fit_parameters, Hypothesis{});
  const std::vector<Prediction> at = posterior.predict(x);
  posterior.update_slow_variance(x, at);
  std::vector<double> deviation;
  for (std::size_t r = 0; r < at.size(); ++r)
    for (const double variance :
         posterior.variance(x, at[r], r, posterior.acceleration_variance(x)))
      deviation.push_back(std::sqrt(variance));
  return {experiment, std::move(fit_parameters), x, std::move(deviation)};
}

}  // namespace

ReferencePoint::ReferencePoint(const Experiment& experiment,
                               std::vector<FitParameter> fit_parameters, Eigen::VectorXd x,
                               std::vector<double> deviation, const PriorSpreads& spreads)
    : experiment_(experiment),
      fit_parameters_(std::move(fit_parameters)),
      x_(std::move(x)),
      half_priors_(x_.size()),
      deviation_(std::move(deviation)),
      state_(state_of(make_chain(experiment, fit_parameters_, x_), x_)) {
  for (Eigen::Index i = 0; i < x_.size(); ++i) {
    const FitParameter& parameter = fit_parameters_[static_cast<std::size_t>(i)];
    const double spread = parameter.nuisance ? spreads.nuisances : spreads.others;
    half_priors_(i) = 0.5 * parameter.description.prior.curvature(x_(i)) / (spread * spread);
    const double h = parameter.description.step_at(x_(i));
    columns_.push_back(change(x_ + h * Eigen::VectorXd::Unit(x_.size(), i)) / h);
  }
}

NominalPoint::NominalPoint(const Experiment& experiment, const ChannelNoise& noise)
    : ReferencePoint(nominal_point(experiment, noise)) {}

Eigen::VectorXd ReferencePoint::change(const Eigen::VectorXd& x, const Effect* left_out) const {
  return change_to(make_chain(experiment_, fit_parameters_, x, left_out), x);
}

Eigen::VectorXd ReferencePoint::change(const Eigen::VectorXd& x, const Effect& effect,
                                       const std::vector<double>& values) const {
  Chain chain = make_chain(experiment_, fit_parameters_, x);
  effect.extend(chain, values, experiment_.scales);
  return change_to(chain, x);
}

double ReferencePoint::beyond_square(const Eigen::VectorXd& change) const {
  const auto log_ratio =
      change.segment(state_.mean.size(), state_.noise.size()).array() * std::sqrt(2.);
  return (log_ratio.exp() - 1. - log_ratio - 0.5 * log_ratio.square()).sum();
}

ReferencePoint::State ReferencePoint::state_of(const Chain& chain, const Eigen::VectorXd& x) const {
  const auto n = static_cast<Eigen::Index>(deviation_.size());
  const double moment = std::exp(2. * x(index_of_moment_noise)),
               acceleration =
                   std::exp(2. * x(index_of_acceleration_noise)) + chain.reference_variance;
  State out{Eigen::VectorXd(2 * n), Eigen::VectorXd(n), {}};
  Eigen::Index row = 0;
  for (const Prediction& there : ChainSimulator(chain).predict(experiment_.records)) {
    const std::vector<double> own = own_noise(there);
    for (std::size_t b = 0; b < there.mean.size(); ++b, ++row) {
      const double deviation = deviation_[static_cast<std::size_t>(row)];
      out.mean(2 * row) = there.mean[b].real() / deviation;
      out.mean(2 * row + 1) = there.mean[b].imag() / deviation;
      out.noise(row) =
          (moment * there.moment_noise[b] + acceleration * there.acceleration_noise[b] + own[b]) /
          (deviation * deviation);
    }
  }
  std::vector<double> at_rest;
  for (const PreparedRecord& record : experiment_.records)
    if (record.n_acceleration_noise > 0)
      at_rest.push_back(std::sqrt(0.5 * static_cast<double>(record.n_acceleration_noise)) *
                        std::log(acceleration));
  out.at_rest = Eigen::Map<const Eigen::VectorXd>(at_rest.data(), std::ssize(at_rest));
  return out;
}

Eigen::VectorXd ReferencePoint::change_to(const Chain& chain, const Eigen::VectorXd& x) const {
  const State moved = state_of(chain, x);
  Eigen::VectorXd out(moved.mean.size() + moved.noise.size() + moved.at_rest.size());
  // The rest of the variance (misfit, model form error) is that of the reference.
  out << moved.mean - state_.mean,
      ((moved.noise - state_.noise).array().max(-0.999).log1p() * std::sqrt(0.5)).matrix(),
      moved.at_rest - state_.at_rest;
  return out;
}

FisherDirections::FisherDirections(const ReferencePoint& point,
                                   const std::vector<Eigen::VectorXd>& further) {
  std::vector<Eigen::VectorXd> all = point.columns();
  all.insert(all.end(), further.begin(), further.end());
  columns_.resize(all.front().size(), std::ssize(all));
  for (std::size_t i = 0; i < all.size(); ++i) columns_.col(static_cast<Eigen::Index>(i)) = all[i];
  overlap_ = columns_.transpose() * columns_;
  gram_ = overlap_;
  gram_.diagonal().head(point.half_priors().size()) += point.half_priors();
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
