#pragma once

#include <array>
#include <vector>

#include "fem/factors/front_elimination.h"
#include "fem/factors/front_layout.h"
#include "fem/factors/large_array.h"
#include "fem/factors/sparse_factors.h"
#include "fem/factors/upper_blocks.h"

namespace vibrissa::fem {

/// Factors of a matrix in one process: multifrontal Cholesky factorisation (Duff and Reid, ACM
/// Trans. Math. Softw. 9, 302 (1983), here without pivoting). A supernode stores its change of the
/// rows below as a dense update, which its parent adds later. Proven by
/// tests/fem/factors/cholesky_solver_test.cc.
class SupernodalFactors : public SparseFactors {
 public:
  explicit SupernodalFactors(const Matrix& matrix);
  void factorise() override;
  void solve(const Vector& right_hand_side, Vector& solution) const override;
  Columns solve(const Columns& right_hand_sides) const override;
  FactorCost cost() const override;

 private:
  /// Update of a front: the lower triangle of the rows below its panel.
  struct Update {
    double* values;
    int n;
    double* column(const int c) const { return values + static_cast<std::ptrdiff_t>(c) * n; }
  };

  double* panel(const std::size_t s) { return factor_.data() + layout_.panels[s].start; }
  void fill_panel(std::size_t s, const double* values);
  void take_in(const Update& child_update, std::size_t child, std::size_t s, const Update& update);
  void find_runs(std::size_t child);
  void eliminate_front(std::size_t s, const Update& update);

  UpperBlocks matrix_;
  FrontLayout layout_;
  LargeArray factor_;
  std::array<LargeArray, 2> stacks_;
  FrontElimination elimination_;
  std::vector<int> position_;  // row of the first unknown of a node in the current front
  std::vector<int> runs_;      // runs of consecutive nodes of a child, and the end
};

}  // namespace vibrissa::fem
