#pragma once

#include <deal.II/base/index_set.h>

#include <Eigen/Dense>
#include <vector>

#include "fem/linalg/linear_algebra.h"
#include "fem/sensor/damping.h"

namespace vibrissa::fem {

/// scale * C of the modal damping on the free unknowns, D W D^T. It has low rank and is not
/// assembled: solutions of (A + D W D^T) x = b follow from solutions with A by Woodbury's identity.
/// Proven by tests/fem/motion/linear_transient_test.cc and finite_strain_stepper_test.cc.
class LowRankDamping {
 public:
  LowRankDamping(const ModalDamping& damping, const dealii::IndexSet& held, double scale);

  /// Columns of D, without the modes that have no damping.
  const std::vector<Vector>& forces() const { return forces_; }
  /// Updates for a new A; solved contains A^-1 D.
  void renew(std::vector<Vector> solved);
  /// Replaces A^-1 b by (A + D W D^T)^-1 b.
  void correct(Vector& solution) const;
  /// force += factor D W D^T u.
  void add(double factor, const Vector& u, Vector& force) const;

 private:
  std::vector<Vector> forces_, solved_;
  std::vector<double> weights_;
  Eigen::LDLT<Eigen::MatrixXd> small_;
};

}  // namespace vibrissa::fem
