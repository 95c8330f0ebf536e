#pragma once

#include <Eigen/Core>
#include <complex>

namespace vibrissa::trial {

/// x' = A x + B f, y = C x + D f.
struct StateSpace {
  Eigen::MatrixXd a, b, c, d;

  Eigen::MatrixXcd response(std::complex<double> s) const;
};

/// Exact steps for inputs that are linear between samples: x1 = transition x0 + now f0 + next f1,
/// by the matrix exponential. Proven by tests/trial/plant/state_space_test.cc.
struct FirstOrderHold {
  FirstOrderHold(const StateSpace& system, double step_s);
  Eigen::MatrixXd transition, now, next;
};

}  // namespace vibrissa::trial
