#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>

#include <Eigen/Dense>
#include <functional>
#include <memory>

#include "signals/error.h"

namespace vibrissa::fem {

/// One back-end for one and for many processes. Vectors are not ghosted unless stated.
using Matrix = dealii::PETScWrappers::MPI::SparseMatrix;
using Vector = dealii::PETScWrappers::MPI::Vector;

/// Several vectors side by side; each process holds its own rows.
using Columns = Eigen::MatrixXd;

/// Turns a PETSc error code into an exception that names the call, std::bad_alloc where memory ran
/// out. Proven by tests/faults/visit_fault_points.py.
void check_petsc(int error_code, const char* call);

/// Sets the given (owned) rows and columns of a symmetric matrix to zero and their diagonal as
/// stated.
void clamp_rows(Matrix& matrix, const dealii::IndexSet& clamped, double diagonal);

/// A copy with clamped rows.
std::unique_ptr<Matrix> with_clamped_rows(const Matrix& matrix, const dealii::IndexSet& clamped,
                                          double diagonal);

/// Sets the given (owned) entries to zero.
void zero_entries(Vector& vector, const dealii::IndexSet& entries);

/// a x + b y; the pattern of y must lie within that of x.
std::unique_ptr<Matrix> combine(double a, const Matrix& x, double b, const Matrix& y);

/// The entries that this process owns, in order.
Eigen::VectorXd owned_entries(const Vector& vector);
void set_owned_entries(const Eigen::VectorXd& entries, Vector& vector);

/// A x for several vectors at once.
Columns multiply(const Matrix& matrix, const Columns& x);

/// The sum over all processes of a small matrix.
Columns sum_over_processes(const Columns& part, MPI_Comm communicator);

/// A matrix that should have been positive definite is not.
class IndefiniteMatrix : public signals::UserError {
 public:
  using signals::UserError::UserError;
};

/// What factors cost, over all processes.
struct FactorCost {
  double entries = 0.;     // of the factors
  double operations = 0.;  // of one factorisation
  double memory_mib = 0.;  // that the factorisation worked in
};

/// Sparse Cholesky factors of a symmetric positive definite matrix (MUMPS), kept for any number of
/// solves, each of a single vector with one step of iterative refinement. Throws IndefiniteMatrix
/// when the matrix is not positive definite, signals::UserError when memory runs out. The matrix
/// must outlive the factors. Proven by tests/fem/newton_test.cc.
class CholeskySolver {
 public:
  /// Product with the matrix for the refinement, where the assembled one is not exact enough;
  /// nothing: the matrix itself.
  using Product = std::function<void(const Vector& x, Vector& product)>;
  explicit CholeskySolver(const Matrix& matrix, Product product = {});
  ~CholeskySolver();
  CholeskySolver(const CholeskySolver&) = delete;
  CholeskySolver& operator=(const CholeskySolver&) = delete;
  /// Anew, after the matrix changed its values but not its pattern: keeps the order of elimination.
  void refactor();
  void solve(const Vector& right_hand_side, Vector& solution) const;
  /// Without refinement, for iterations that correct themselves.
  void solve_once(const Vector& right_hand_side, Vector& solution) const;
  /// Several right-hand sides at once, without refinement: about the price of two.
  Columns solve(const Columns& right_hand_sides) const;
  FactorCost cost() const;

 private:
  struct Factors;
  const Matrix& matrix_;
  Product product_;
  std::unique_ptr<Factors> factors_;
};

}  // namespace vibrissa::fem
