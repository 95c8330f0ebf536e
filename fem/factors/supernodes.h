#pragma once

#include <cstddef>
#include <vector>

namespace vibrissa::fem {

/// The order in which a Cholesky factorisation eliminates the nodes of a symmetric pattern, and its
/// supernodes: consecutive columns of the factor with the same rows, each stored as one dense
/// front. Uses nested dissection by METIS and the analysis of CHOLMOD, which merges small
/// supernodes and stores some zeros (Chen, Davis, Hager and Rajamanickam, ACM Trans. Math. Softw.
/// 35, 22 (2008)). Throws std::bad_alloc. Proven by tests/fem/factors/cholesky_solver_test.cc.
struct Supernodes {
  /// From the upper triangle in compressed rows, columns ascending.
  Supernodes(const std::vector<int>& start, const std::vector<int>& columns);

  std::size_t size() const { return parent.size(); }
  int n_columns(const std::size_t s) const { return first[s + 1] - first[s]; }
  int n_rows(const std::size_t s) const { return static_cast<int>(start[s + 1] - start[s]); }
  int n_below(const std::size_t s) const { return n_rows(s) - n_columns(s); }
  const int* rows_of(const std::size_t s) const { return rows.data() + start[s]; }
  const int* below(const std::size_t s) const { return rows_of(s) + n_columns(s); }

  std::vector<int> order;          // the node of each column of the factor
  std::vector<int> of_column;      // the supernode of each column
  std::vector<int> first;          // first column of each supernode, and the end
  std::vector<std::size_t> start;  // start of the rows of each supernode, and the end
  std::vector<int> rows;           // ascending, the own columns first
  std::vector<int> parent;         // supernode that adds its update, or -1; has a higher number
  std::vector<std::vector<std::size_t>> children;  // ascending
};

}  // namespace vibrissa::fem
