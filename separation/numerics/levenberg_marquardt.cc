#include "separation/numerics/levenberg_marquardt.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace vibrissa::separation {

namespace {

// Reciprocal condition of the scaled J^T J below which a direction is not determined: rounding
// leaves about n * 1e-16 of it.
constexpr double singular = 1e-13;

Eigen::VectorXd column_scale(const Eigen::MatrixXd& matrix) {
  Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt();
  for (double& s : scale)
    if (!(s > 0.)) s = 1.;
  return scale;
}

Eigen::VectorXd damped_step(const NormalEquations& equations, double damping) {
  const Eigen::VectorXd scale = column_scale(equations.matrix);
  Eigen::MatrixXd scaled =
      scale.cwiseInverse().asDiagonal() * equations.matrix * scale.cwiseInverse().asDiagonal();
  scaled.diagonal().array() += damping;
  return scaled.ldlt().solve(equations.gradient.cwiseQuotient(scale)).cwiseQuotient(scale);
}

// What the linearised cost loses by a step.
double predicted_gain(const NormalEquations& equations, const Eigen::VectorXd& step) {
  return 2. * step.dot(equations.gradient) - step.dot(equations.matrix * step);
}

class Descent {
 public:
  Descent(const Eigen::VectorXd& start, const Linearise& linearise, const LevenbergOptions& options)
      : linearise_(linearise), options_(options) {
    result_.parameters = start;
    [[maybe_unused]] const bool admissible = evaluate(start, result_.equations);
    assert(admissible);
  }

  LevenbergResult run() {
    while (!done()) {
      if (result_.n_iterations >= options_.max_iterations) {
        result_.end = FitEnd::step_limit;
        break;
      }
      try_step();
    }
    if (inverse_information(result_.equations.matrix).size() == 0)
      result_.end = FitEnd::poor_excitation;
    return std::move(result_);
  }

 private:
  bool evaluate(const Eigen::VectorXd& parameters, NormalEquations& equations) {
    ++result_.n_iterations;
    return linearise_(parameters, equations) && std::isfinite(equations.cost);
  }

  bool done() const { return finished_ || result_.equations.cost <= options_.negligible_cost; }

  double small_gain() const {
    const double n_free =
        std::max(1., options_.n_residuals - static_cast<double>(result_.parameters.size()));
    return std::pow(options_.tolerance, 2) * result_.equations.cost / n_free;
  }

  void try_step() {
    const Eigen::VectorXd step = damped_step(result_.equations, damping_);
    const double gain = predicted_gain(result_.equations, step);
    const bool last = damping_ <= 1e-2 && gain <= small_gain();
    const Eigen::VectorXd trial = result_.parameters + step;
    if (!evaluate(trial, trial_)) {
      refuse(gain, true);
    } else if (!(trial_.cost < result_.equations.cost)) {
      if (last) finished_ = true;
      refuse(gain, false);
    } else {
      const double ratio = (result_.equations.cost - trial_.cost) / gain;
      result_.parameters = trial;
      std::swap(result_.equations, trial_);
      if (ratio > 0.75) damping_ = std::max(1e-12, damping_ / 30.);
      if (ratio < 0.25) damping_ *= 4.;
      finished_ = last;
    }
  }

  void refuse(double gain, bool inadmissible) {
    damping_ = std::max(1e-6, 8. * damping_);
    // With this damping a step changes the cost by less than rounding.
    if (damping_ > 1e10 || gain <= 1e-14 * result_.equations.cost) {
      finished_ = true;
      if (inadmissible) result_.end = FitEnd::unstable;
    }
  }

  const Linearise& linearise_;
  LevenbergOptions options_;
  LevenbergResult result_;
  NormalEquations trial_;
  double damping_ = 1e-4;
  bool finished_ = false;
};

}  // namespace

void NormalEquations::add_segment(const Eigen::MatrixXd& gram, const Eigen::Index n_model,
                                  const Eigen::Index first_nuisance) {
  const Eigen::Index m = n_model, tail = n_model + 1, q = gram.cols() - tail;
  cost += gram(m, m);
  matrix.topLeftCorner(m, m) += gram.topLeftCorner(m, m);
  gradient.head(m) += gram.col(m).head(m);
  matrix.block(0, first_nuisance, m, q) = gram.block(0, tail, m, q);
  matrix.block(first_nuisance, 0, q, m) = gram.block(tail, 0, q, m);
  matrix.block(first_nuisance, first_nuisance, q, q) = gram.block(tail, tail, q, q);
  gradient.segment(first_nuisance, q) = gram.col(m).segment(tail, q);
}

std::string to_string(FitEnd end) {
  switch (end) {
    case FitEnd::converged:
      return "converged";
    case FitEnd::step_limit:
      return "step_limit";
    case FitEnd::unstable:
      return "unstable";
    case FitEnd::poor_excitation:
      return "poor_excitation";
  }
  return {};
}

LevenbergResult minimise(const Eigen::VectorXd& start, const Linearise& linearise,
                         const LevenbergOptions& options) {
  return Descent(start, linearise, options).run();
}

Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite() || !(matrix.diagonal().minCoeff() > 0.)) return {};
  const Eigen::VectorXd inverse_scale = column_scale(matrix).cwiseInverse();
  const Eigen::MatrixXd scaled = inverse_scale.asDiagonal() * matrix * inverse_scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  const Eigen::VectorXd& values = solver.eigenvalues();
  if (!(values.minCoeff() > singular * values.maxCoeff())) return {};
  const Eigen::MatrixXd inverse = solver.eigenvectors() * values.cwiseInverse().asDiagonal() *
                                  solver.eigenvectors().transpose();
  return inverse_scale.asDiagonal() * inverse * inverse_scale.asDiagonal();
}

}  // namespace vibrissa::separation
