#pragma once

#include <memory>

#include "fem/linalg/linear_algebra.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

/// A matrix that must be positive definite is not.
class IndefiniteMatrix : public signals::InternalError {
 public:
  using signals::InternalError::InternalError;
};

[[noreturn]] void throw_indefinite();

/// Cost of the factors, summed over all processes.
struct FactorCost {
  double entries = 0.;     // number of entries of the factors
  double operations = 0.;  // number of operations of one factorisation
  double memory_mib = 0.;  // memory of the factorisation
};

/// Cholesky factors of a matrix, by one of several libraries. The matrix must outlive them.
class SparseFactors {
 public:
  virtual ~SparseFactors() = default;
  /// Factorises the current values of the matrix; the pattern must not change. Throws
  /// IndefiniteMatrix, and std::bad_alloc or signals::UserError when there is not enough memory.
  virtual void factorise() = 0;
  virtual void solve(const Vector& right_hand_side, Vector& solution) const = 0;
  virtual Columns solve(const Columns& right_hand_sides) const = 0;
  virtual FactorCost cost() const = 0;
};

/// Creates factors, not yet factorised: fem/factors/supernodal_factors.h for one process, MUMPS for
/// several.
std::unique_ptr<SparseFactors> make_factors(const Matrix& matrix);

}  // namespace vibrissa::fem
