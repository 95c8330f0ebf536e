#include "diagnosis/search/needless_calibrations.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

/// First parameters of the calibration effects of a fit, which decide whether they vanish.
std::vector<Eigen::Index> deciding_parameters(const HypothesisFit& fit) {
  std::vector<Eigen::Index> out;
  for (std::size_t i = n_common_parameters; i < fit.fit_parameters.size(); ++i)
    if (fit.fit_parameters[i].nuisance && fit.fit_parameters[i].parameter == 0)
      out.push_back(static_cast<Eigen::Index>(i));
  return out;
}

/// Marginal likelihood of these parameters around the fit, without their priors.
class CalibrationLikelihood {
 public:
  CalibrationLikelihood(const HypothesisFit& fit, const std::vector<Eigen::Index>& at)
      : x_(fit.x(at)), slope_(x_.size()), information_(fit.covariance(at, at).inverse()) {
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      priors_.push_back(
          &fit.fit_parameters[static_cast<std::size_t>(at[static_cast<std::size_t>(i)])]
               .description.prior);
      information_(i, i) -= priors_.back()->curvature(x_(i));
      slope_(i) = -priors_.back()->slope(x_(i));
    }
  }

  /// Log evidence when the parameters whose bit is not set are nominal, up to a constant.
  double log_evidence(const std::size_t set) const {
    constexpr int n_steps = 20;
    Eigen::VectorXd x = x_;
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if ((set >> i & 1) != 0)
        free.push_back(i);
      else
        x(i) = priors_[static_cast<std::size_t>(i)]->centre;
    Eigen::MatrixXd curvature;
    for (int step = 0; step < n_steps; ++step) {
      Eigen::VectorXd gradient = slope_ - information_ * (x - x_);
      curvature = information_(free, free);
      for (std::size_t k = 0; k < free.size(); ++k) {
        const Prior& prior = *priors_[static_cast<std::size_t>(free[k])];
        gradient(free[k]) += prior.slope(x(free[k]));
        curvature(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) +=
            prior.curvature(x(free[k]));
      }
      x(free) += curvature.ldlt().solve(gradient(free));
    }
    const Eigen::VectorXd way = x - x_;
    double sum = slope_.dot(way) - 0.5 * way.dot(information_ * way);
    for (const Eigen::Index i : free)
      sum += priors_[static_cast<std::size_t>(i)]->log_density(x(i));
    if (free.empty()) return sum;
    return sum - 0.5 * curvature.ldlt().vectorD().array().log().sum() +
           0.5 * static_cast<double>(free.size()) * std::log(2. * std::numbers::pi);
  }

 private:
  Eigen::VectorXd x_, slope_;
  Eigen::MatrixXd information_;
  std::vector<const Prior*> priors_;
};

}  // namespace

std::vector<std::string> needless_calibrations(const HypothesisFit& fit) {
  const std::vector<Eigen::Index> at = deciding_parameters(fit);
  const CalibrationLikelihood likelihood(fit, at);
  std::size_t best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t set = 0; set < std::size_t{1} << at.size(); ++set)
    if (const double value = likelihood.log_evidence(set); value > most) {
      most = value;
      best = set;
    }
  std::vector<std::string> out;
  for (std::size_t i = 0; i < at.size(); ++i)
    if ((best >> i & 1) == 0)
      out.push_back(fit.fit_parameters[static_cast<std::size_t>(at[i])].effect->id);
  return out;
}

}  // namespace vibrissa::diagnosis
