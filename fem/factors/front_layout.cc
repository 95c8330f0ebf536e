#include "fem/factors/front_layout.h"

#include <algorithm>

namespace vibrissa::fem {

FrontLayout::FrontLayout(const UpperBlocks& matrix)
    : block_size(matrix.block_size()), supernodes(matrix.start(), matrix.columns()) {
  make_panels();
  make_stacks();
  place_entries(matrix);
}

std::size_t FrontLayout::update_size(const std::size_t s) const {
  const auto n = static_cast<std::size_t>(panels[s].n_below());
  return n * n;
}

int FrontLayout::most_rows() const {
  int most = 0;
  for (const Panel& panel : panels) most = std::max(most, panel.n_rows);
  return most;
}

void FrontLayout::make_panels() {
  constexpr std::size_t line = 8;  // numbers of a cache line
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    const int n_columns = block_size * supernodes.n_columns(s);
    const int n_rows = block_size * supernodes.n_rows(s);
    panels.push_back({n_columns, n_rows, factor_size});
    const auto n = static_cast<std::size_t>(n_columns) * static_cast<std::size_t>(n_rows);
    factor_size += (n + line - 1) / line * line;
  }
}

void FrontLayout::make_stacks() {
  stack.assign(supernodes.size(), 0);
  for (std::size_t s = supernodes.size(); s-- > 0;) {
    for (const auto child : supernodes.children[s]) stack[child] = 1 - stack[s];
  }
  std::array<std::size_t, 2> used{};
  for (std::size_t s = 0; s < supernodes.size(); ++s) {
    const std::size_t own = stack[s];
    used[own] += update_size(s);
    stack_size[own] = std::max(stack_size[own], used[own]);
    for (const auto child : supernodes.children[s]) used[1 - own] -= update_size(child);
  }
}

void FrontLayout::place_entries(const UpperBlocks& matrix) {
  std::vector<int> column_of(supernodes.order.size());
  for (std::size_t c = 0; c < column_of.size(); ++c)
    column_of[static_cast<std::size_t>(supernodes.order[c])] = static_cast<int>(c);
  std::vector<std::vector<Entry>> of_panel(panels.size());
  for (std::size_t row = 0; row < column_of.size(); ++row) {
    for (int e = matrix.start()[row]; e < matrix.start()[row + 1]; ++e) {
      const auto block = static_cast<std::uint32_t>(e);
      const int here = column_of[row];
      const int there = column_of[static_cast<std::size_t>(matrix.columns()[block])];
      const auto [column, below] = std::minmax(here, there);
      const auto s =
          static_cast<std::size_t>(supernodes.of_column[static_cast<std::size_t>(column)]);
      const int* const rows = supernodes.rows_of(s);
      const auto row_in_panel = std::lower_bound(rows, rows + supernodes.n_rows(s), below) - rows;
      const std::ptrdiff_t place =
          block_size *
          (static_cast<std::ptrdiff_t>(column - rows[0]) * panels[s].n_rows + row_in_panel);
      of_panel[s].push_back(
          {panels[s].start + static_cast<std::size_t>(place), block, here > there});
    }
  }
  for (const auto& some : of_panel) {
    entries_start.push_back(entries.size());
    entries.insert(entries.end(), some.begin(), some.end());
  }
  entries_start.push_back(entries.size());
}

}  // namespace vibrissa::fem
