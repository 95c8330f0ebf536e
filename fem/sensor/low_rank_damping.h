#pragma once

#include <deal.II/base/index_set.h>

#include <Eigen/Dense>
#include <vector>

#include "fem/linalg/linear_algebra.h"
#include "fem/sensor/damping.h"

namespace vibrissa::fem {

/// scale C of the modal damping on the unknowns that are not held, D W D^T, of low rank: it need
/// not be assembled. Solutions of (A + D W D^T) x = b come from those of A by Woodbury's identity.
/// Proven by tests/fem/motion/linear_transient_test.cc and finite_strain_stepper_test.cc.
class LowRankDamping {
 public:
  LowRankDamping(const ModalDamping& damping, const dealii::IndexSet& held, double scale);

  /// Columns of D, those of modes without damping left out.
  const std::vector<Vector>& forces() const { return forces_; }
  /// Of A: solved holds A^-1 D.
  void renew(std::vector<Vector> solved);
  /// From A^-1 b to (A + D W D^T)^-1 b.
  void correct(Vector& solution) const;
  /// force += factor D W D^T u.
  void add(double factor, const Vector& u, Vector& force) const;

 private:
  std::vector<Vector> forces_, solved_;
  std::vector<double> weights_;
  Eigen::LDLT<Eigen::MatrixXd> small_;
};

}  // namespace vibrissa::fem
