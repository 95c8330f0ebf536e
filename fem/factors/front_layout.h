#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fem/factors/supernodes.h"
#include "fem/factors/upper_blocks.h"

namespace vibrissa::fem {

/// Where the numbers of a multifrontal factorisation lie: the panel of every supernode within the
/// factor, the matrix's blocks within the panels, and the updates that wait for their parents.
/// Proven by tests/fem/factors/cholesky_solver_test.cc.
struct FrontLayout {
  /// A supernode's columns of the factor, one after another: its own rows, of which the lower
  /// triangle counts, and those below.
  struct Panel {
    int n_columns, n_rows;  // unknowns
    std::size_t start;      // among the values of the factor
    int n_below() const { return n_rows - n_columns; }
  };
  /// A block of the matrix in the panel that it belongs to.
  struct Entry {
    std::size_t place;  // of its first number, among the values of the factor
    std::uint32_t block;
    bool transposed;
  };

  explicit FrontLayout(const UpperBlocks& matrix);

  /// Numbers of the update that a supernode leaves to its parent.
  std::size_t update_size(std::size_t s) const;
  int most_rows() const;

  int block_size;  // unknowns of a node
  Supernodes supernodes;
  std::vector<Panel> panels;
  std::size_t factor_size = 0;
  std::vector<Entry> entries;              // panel by panel
  std::vector<std::size_t> entries_start;  // of each panel, and the end
  /// Updates of even and of odd depth in the tree have a stack each: in postorder a parent's is put
  /// on the one while its children's are on top of the other.
  std::vector<std::uint8_t> stack;  // of each supernode's update
  std::array<std::size_t, 2> stack_size{};

 private:
  void make_panels();
  void make_stacks();
  void place_entries(const UpperBlocks& matrix);
};

}  // namespace vibrissa::fem
