#include "trial/plant/state_space.h"

#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

namespace vibrissa::trial {

Eigen::MatrixXcd StateSpace::response(const std::complex<double> s) const {
  const Eigen::MatrixXcd pencil =
      s * Eigen::MatrixXcd::Identity(a.rows(), a.cols()) - a.cast<std::complex<double>>();
  return c * pencil.partialPivLu().solve(b.cast<std::complex<double>>()) + d;
}

FirstOrderHold::FirstOrderHold(const StateSpace& system, const double step_s) {
  const Eigen::Index n = system.a.rows(), m = system.b.cols();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + 2 * m, n + 2 * m);
  all.topLeftCorner(n, n) = system.a * step_s;
  all.block(0, n, n, m) = system.b * step_s;
  all.block(n, n + m, m, m).setIdentity();
  const Eigen::MatrixXd step = all.exp();
  transition = step.topLeftCorner(n, n);
  next = step.block(0, n + m, n, m);
  now = step.block(0, n, n, m) - next;
}

}  // namespace vibrissa::trial
