#pragma once

#include <Eigen/Core>
#include <vector>

#include "separation/model/rational_model.h"

namespace vibrissa::separation {

/// The quotient of two rational functions over common poles D_k = s^2 + a1_k s + a0_k,
///   [d + sum_k (b1_k s + b0_k) / D_k] / [1 + sum_k (c1_k s + c0_k) / D_k],
/// as a modal model; its poles are the zeros of the denominator. modes holds D_k and b_k; the
/// denominator is (c1, c0) of each mode. Two real poles make one mode. Method: eigenvalues of the
/// inverse system, in states scaled to equal size. Unstable results are returned unchanged. Proven
/// by tests/separation/model/partial_fractions_test.cc.
Bvrm quotient(const std::vector<ModalTerm>& modes, double direct_term,
              const Eigen::VectorXd& denominator);

}  // namespace vibrissa::separation
