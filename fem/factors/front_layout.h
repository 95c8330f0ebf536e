#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fem/factors/supernodes.h"
#include "fem/factors/upper_blocks.h"

namespace vibrissa::fem {

/// Memory layout of a multifrontal factorisation: the panel of every supernode in the factor, the
/// blocks of the matrix in the panels, and the stored updates for the parents. Proven by
/// tests/fem/factors/cholesky_solver_test.cc.
struct FrontLayout {
  /// The columns of a supernode in the factor: its own rows (lower triangle) and the rows below.
  struct Panel {
    int n_columns, n_rows;  // unknowns
    std::size_t start;      // index in the values of the factor
    int n_below() const { return n_rows - n_columns; }
  };
  /// A block of the matrix in its panel.
  struct Entry {
    std::size_t place;  // index of its first number in the values of the factor
    std::uint32_t block;
    bool transposed;
  };

  explicit FrontLayout(const UpperBlocks& matrix);

  /// Size of the update that a supernode passes to its parent.
  std::size_t update_size(std::size_t s) const;
  int most_rows() const;

  int block_size;  // unknowns of a node
  Supernodes supernodes;
  std::vector<Panel> panels;
  std::size_t factor_size = 0;
  std::vector<Entry> entries;              // panel by panel
  std::vector<std::size_t> entries_start;  // start for each panel, and the end
  /// Updates of even and of odd depth in the tree have one stack each: in postorder, the update of
  /// a parent is put on one stack while the updates of its children are on top of the other.
  std::vector<std::uint8_t> stack;  // stack of the update of each supernode
  std::array<std::size_t, 2> stack_size{};

 private:
  void make_panels();
  void make_stacks();
  void place_entries(const UpperBlocks& matrix);
};

}  // namespace vibrissa::fem
