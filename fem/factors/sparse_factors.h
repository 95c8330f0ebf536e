#pragma once

#include <memory>

#include "fem/linalg/linear_algebra.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

/// A matrix that should have been positive definite is not.
class IndefiniteMatrix : public signals::InternalError {
 public:
  using signals::InternalError::InternalError;
};

[[noreturn]] void throw_indefinite();

/// What factors cost, over all processes.
struct FactorCost {
  double entries = 0.;     // of the factors
  double operations = 0.;  // of one factorisation
  double memory_mib = 0.;  // that the factorisation worked in
};

/// Cholesky factors of a matrix that outlives them, as one library or another makes them.
class SparseFactors {
 public:
  virtual ~SparseFactors() = default;
  /// Of the matrix's current values, in its first pattern. Throws IndefiniteMatrix,
  /// std::bad_alloc, signals::UserError where memory runs out.
  virtual void factorise() = 0;
  virtual void solve(const Vector& right_hand_side, Vector& solution) const = 0;
  virtual Columns solve(const Columns& right_hand_sides) const = 0;
  virtual FactorCost cost() const = 0;
};

/// Our own (fem/factors/supernodal_factors.h) for one process, those of MUMPS for several; made,
/// but not factorised.
std::unique_ptr<SparseFactors> make_factors(const Matrix& matrix);

}  // namespace vibrissa::fem
