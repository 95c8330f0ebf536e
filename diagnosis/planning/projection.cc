#include "diagnosis/planning/projection.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace vibrissa::diagnosis {
namespace {

/// Remaining nats that count as zero.
constexpr double surely_followed = 0.5;

/// Remaining distance between a change and its followers, including the cost of the followers.
class LeastSquaresProjection {
 public:
  LeastSquaresProjection(const ReferencePoint& point, const Eigen::VectorXd& change,
                         const std::vector<std::size_t>& fit_parameters,
                         const std::optional<Alternative>& alternative)
      : point_(point), change_(change), fit_parameters_(fit_parameters), alternative_(alternative) {
    for (const std::size_t i : fit_parameters) {
      const auto index = static_cast<Eigen::Index>(i);
      add(point.fit_parameters()[i].description, point.x()(index), point.half_priors()(index));
    }
    for (std::size_t i = 0; alternative && i < alternative->values.size(); ++i) {
      const Parameter& own = alternative->effect->parameters[i];
      add(own, std::clamp(own.coordinate(alternative->values[i]), own.prior.low, own.prior.high),
          0.);
    }
    centre_ = z_;
    residual_ = residual(z_);
    cost_ = cost(z_, residual_);
    set_columns(true);
  }

  Projection run() {
    constexpr int n_steps = 14;
    for (int i = 0; i < n_steps && !ended_; ++i) step();
    if (!alternative_) return {.left = cost_};
    const Eigen::VectorXd alone = point_.change(parameters_at(z_));
    return {.left = cost_,
            .alternative_energy = std::min(point_.mean_energy(change_),
                                           point_.mean_energy(change_ - residual_ - alone))};
  }

 private:
  void add(const Parameter& parameter, const double z, const double half_prior) {
    descriptions_.push_back(&parameter);
    const auto append = [](Eigen::VectorXd& to, const double value) {
      to.conservativeResize(to.size() + 1);
      to(to.size() - 1) = value;
    };
    append(z_, z);
    append(low_, parameter.prior.low);
    append(high_, parameter.prior.high);
    append(half_prior_, half_prior);
  }

  Eigen::VectorXd parameters_at(const Eigen::VectorXd& z) const {
    Eigen::VectorXd x = point_.x();
    for (std::size_t i = 0; i < fit_parameters_.size(); ++i)
      x(static_cast<Eigen::Index>(fit_parameters_[i])) = z(static_cast<Eigen::Index>(i));
    return x;
  }

  Eigen::VectorXd residual(const Eigen::VectorXd& z) const {
    const Eigen::VectorXd x = parameters_at(z);
    if (!alternative_) return change_ - point_.change(x);
    std::vector<double> values;
    for (std::size_t i = fit_parameters_.size(); i < static_cast<std::size_t>(z.size()); ++i)
      values.push_back(descriptions_[i]->value(z(static_cast<Eigen::Index>(i))));
    return change_ - point_.change(x, *alternative_->effect, values);
  }

  double cost(const Eigen::VectorXd& z, const Eigen::VectorXd& residual) const {
    const double sum =
        residual.squaredNorm() + (half_prior_.array() * (z - centre_).array().square()).sum();
    return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
  }

  /// Derivatives at z; those by the parameters are known at the start.
  void set_columns(bool at_start) {
    columns_.resize(residual_.size(), z_.size());
    for (Eigen::Index i = 0; i < z_.size(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      if (at_start && index < fit_parameters_.size()) {
        columns_.col(i) = point_.columns()[fit_parameters_[index]];
        continue;
      }
      Eigen::VectorXd z = z_;
      const double h = descriptions_[index]->step_at(z(i));
      z(i) += h;
      columns_.col(i) = (residual_ - residual(z)) / h;
      if (!columns_.col(i).allFinite()) columns_.col(i).setZero();
    }
    information_ = columns_.transpose() * columns_;
    information_.diagonal() += half_prior_;
    fresh_ = true;
  }

  /// Best step of the chosen coordinates for a given step of the others. Directions that differ
  /// only by rounding count once.
  Eigen::VectorXd move_of(const std::vector<Eigen::Index>& free, const Eigen::VectorXd& moved,
                          const Eigen::VectorXd& uphill) const {
    constexpr double same = 1e-9;
    Eigen::MatrixXd matrix = information_(free, free);
    matrix.diagonal() *= 1. + damping_;
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
    factors.setThreshold(same);
    factors.compute(scale.asDiagonal() * matrix * scale.asDiagonal());
    return scale.asDiagonal() *
           factors.solve(scale.asDiagonal() * (uphill - information_ * moved)(free));
  }

  /// The other coordinates continue when one is held at its bound.
  Eigen::VectorXd damped_move() const {
    const Eigen::VectorXd uphill =
        columns_.transpose() * residual_ - half_prior_.cwiseProduct(z_ - centre_);
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < z_.size(); ++i)
      if (information_(i, i) > 0.) free.push_back(i);
    Eigen::VectorXd held = Eigen::VectorXd::Zero(z_.size());
    while (!free.empty()) {
      const Eigen::VectorXd part = move_of(free, held, uphill);
      std::vector<Eigen::Index> inside;
      for (std::size_t i = 0; i < free.size(); ++i) {
        const Eigen::Index index = free[i];
        const double to = z_(index) + part(static_cast<Eigen::Index>(i));
        const double bounded = std::clamp(to, low_(index), high_(index));
        if (bounded == to)
          inside.push_back(index);
        else
          held(index) = bounded - z_(index);
      }
      if (inside.size() == free.size()) {
        held(free) = part;
        break;
      }
      free = std::move(inside);
    }
    return held;
  }

  /// One Levenberg-Marquardt step; derivatives are recomputed when they predict badly.
  void step() {
    constexpr double far = 200., worthwhile_when_far = 0.3;
    constexpr double worthwhile = 0.02, untrusted = 0.1, negligible = 0.2, most_damping = 1e3;
    const Eigen::VectorXd z = (z_ + damped_move()).cwiseMax(low_).cwiseMin(high_);
    const Eigen::VectorXd predicted_residual = residual_ - columns_ * (z - z_);
    const double predicted = cost(z, predicted_residual);
    const double least_gain = predicted > far ? worthwhile_when_far : worthwhile;
    if (cost_ - predicted < least_gain * cost_) {
      // No step improves: optimal, unless the derivatives belong to another point.
      ended_ = fresh_ || predicted_well_;
      if (!ended_) set_columns(false);
      return;
    }
    Eigen::VectorXd there = residual(z);
    const double value = cost(z, there);
    if (!(value < cost_)) {
      if (!fresh_) {
        set_columns(false);
        return;
      }
      damping_ = std::max(1e-2, 10. * damping_);
      ended_ = damping_ > most_damping;
      return;
    }
    ended_ = value < surely_followed;
    z_ = z;
    residual_ = std::move(there);
    cost_ = value;
    damping_ *= 0.2;
    fresh_ = false;
    predicted_well_ = value - predicted < std::max(negligible, untrusted * predicted);
    if (!ended_ && !predicted_well_) set_columns(false);
  }

  const ReferencePoint& point_;
  const Eigen::VectorXd& change_;
  const std::vector<std::size_t>& fit_parameters_;
  const std::optional<Alternative>& alternative_;
  std::vector<const Parameter*> descriptions_;
  Eigen::VectorXd z_, half_prior_, low_, high_, centre_, residual_;
  Eigen::MatrixXd columns_, information_;
  double cost_ = 0., damping_ = 1e-4;
  bool fresh_ = false, predicted_well_ = false, ended_ = false;
};

}  // namespace

Projection project(const ReferencePoint& point, const Eigen::VectorXd& change,
                   const std::vector<std::size_t>& fit_parameters,
                   const std::optional<Alternative>& alternative) {
  return LeastSquaresProjection(point, change, fit_parameters, alternative).run();
}

}  // namespace vibrissa::diagnosis
