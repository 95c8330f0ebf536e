#pragma once

#include <petscksp.h>

#include "fem/factors/sparse_factors.h"

namespace vibrissa::fem {

/// Factors that are distributed over several processes, by MUMPS through PETSc. Proven by
/// tests/fem/linalg/processes_test.cc.
class MumpsFactors : public SparseFactors {
 public:
  explicit MumpsFactors(const Matrix& matrix);
  void factorise() override;
  void solve(const Vector& right_hand_side, Vector& solution) const override;
  Columns solve(const Columns& right_hand_sides) const override;
  FactorCost cost() const override;

 private:
  struct Solver {
    explicit Solver(MPI_Comm communicator);
    ~Solver();
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;
    KSP raw = nullptr;
  };

  const Matrix& matrix_;
  Solver solver_;
};

}  // namespace vibrissa::fem
