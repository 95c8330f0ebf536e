#include "fem/factors/supernodal_factors.h"

#include <algorithm>

#include "fem/factors/panel_solution.h"

namespace vibrissa::fem {

SupernodalFactors::SupernodalFactors(const Matrix& matrix)
    : matrix_(matrix),
      layout_(matrix_),
      factor_(layout_.factor_size),
      stacks_{LargeArray(layout_.stack_size[0]), LargeArray(layout_.stack_size[1])},
      elimination_(layout_.most_rows()),
      position_(layout_.supernodes.order.size()) {}

void SupernodalFactors::factorise() {
  const Supernodes& supernodes = layout_.supernodes;
  matrix_.read([&](const double* const values) {
    std::array<std::size_t, 2> top{};
    std::vector<Update> updates;
    for (std::size_t s = 0; s < supernodes.size(); ++s) {
      const std::size_t own = layout_.stack[s];
      const Update& update =
          updates.emplace_back(Update{stacks_[own].data() + top[own], layout_.panels[s].n_below()});
      top[own] += layout_.update_size(s);
      for (int c = 0; c < update.n; ++c)
        std::fill(update.column(c) + c, update.column(c) + update.n, 0.);
      fill_panel(s, values);
      for (const auto child : supernodes.children[s]) {
        take_in(updates[child], child, s, update);
        top[1 - own] -= layout_.update_size(child);
      }
      eliminate_front(s, update);
    }
  });
}

void SupernodalFactors::fill_panel(const std::size_t s, const double* const values) {
  const auto n = static_cast<std::size_t>(layout_.block_size);
  const auto stride = static_cast<std::size_t>(layout_.panels[s].n_rows);
  std::fill_n(panel(s), stride * static_cast<std::size_t>(layout_.panels[s].n_columns), 0.);
  for (auto e = layout_.entries_start[s]; e < layout_.entries_start[s + 1]; ++e) {
    const FrontLayout::Entry& entry = layout_.entries[e];
    const double* const from = values + n * n * entry.block;
    double* const to = factor_.data() + entry.place;
    // A block right of the matrix's diagonal is one below that of the factor, the other way round,
    // unless the order of elimination has turned it over.
    const std::size_t row = entry.transposed ? 1 : n, column = entry.transposed ? n : 1;
    for (std::size_t c = 0; c < n; ++c)
      for (std::size_t r = 0; r < n; ++r) to[c * stride + r] = from[r * row + c * column];
  }
  for (int k = 0; k < layout_.supernodes.n_rows(s); ++k) {
    const int node = layout_.supernodes.rows_of(s)[k];
    position_[static_cast<std::size_t>(node)] = layout_.block_size * k;
  }
}

void SupernodalFactors::find_runs(const std::size_t child) {
  const int* const nodes = layout_.supernodes.below(child);
  const int n_nodes = layout_.supernodes.n_below(child);
  const auto position = [&](const int k) { return position_[static_cast<std::size_t>(nodes[k])]; };
  runs_.clear();
  for (int k = 0; k < n_nodes; ++k) {
    if (k == 0 || position(k) != position(k - 1) + layout_.block_size) runs_.push_back(k);
  }
  runs_.push_back(n_nodes);
}

/// Adds a child's update to the front, its panel and its own update.
void SupernodalFactors::take_in(const Update& child_update, const std::size_t child,
                                const std::size_t s, const Update& update) {
  const FrontLayout::Panel& shape = layout_.panels[s];
  const int* const nodes = layout_.supernodes.below(child);
  const int n_nodes = layout_.supernodes.n_below(child), size = layout_.block_size;
  const auto position = [&](const int k) { return position_[static_cast<std::size_t>(nodes[k])]; };
  find_runs(child);
  std::size_t first_run = 0;
  for (int k = 0; k < n_nodes; ++k) {
    if (k == runs_[first_run + 1]) ++first_run;
    for (int a = 0; a < size; ++a) {
      const double* const from = child_update.column(size * k + a);
      const int column = position(k) + a;
      double* const to = column < shape.n_columns
                             ? panel(s) + static_cast<std::ptrdiff_t>(column) * shape.n_rows
                             : update.column(column - shape.n_columns) - shape.n_columns;
      for (auto run = first_run; run + 1 < runs_.size(); ++run) {
        const int begin = std::max(k, runs_[run]), n = size * (runs_[run + 1] - begin);
        const double* const in = from + static_cast<std::ptrdiff_t>(size) * begin;
        double* const out = to + position(begin);
        for (int i = 0; i < n; ++i) out[i] += in[i];
      }
    }
  }
}

void SupernodalFactors::eliminate_front(const std::size_t s, const Update& update) {
  const FrontLayout::Panel& shape = layout_.panels[s];
  const DenseBlock front{panel(s), shape.n_rows};
  if (!elimination_.eliminate(shape.n_rows, shape.n_columns, front)) throw_indefinite();
  elimination_.subtract_square(update.n, update.n, shape.n_columns, front.at(shape.n_columns, 0),
                               {update.values, update.n});
}

Columns SupernodalFactors::solve(const Columns& right_hand_sides) const {
  const auto& order = layout_.supernodes.order;
  const Eigen::Index size = layout_.block_size, n = static_cast<Eigen::Index>(order.size());
  Columns ordered(right_hand_sides.rows(), right_hand_sides.cols()), solution(ordered);
  for (Eigen::Index v = 0; v < ordered.cols(); ++v)
    for (Eigen::Index c = 0; c < n; ++c)
      ordered.col(v).segment(size * c, size) =
          right_hand_sides.col(v).segment(size * order[static_cast<std::size_t>(c)], size);
  solve_by_panels(layout_, factor_.data(), ordered);
  for (Eigen::Index v = 0; v < ordered.cols(); ++v)
    for (Eigen::Index c = 0; c < n; ++c)
      solution.col(v).segment(size * order[static_cast<std::size_t>(c)], size) =
          ordered.col(v).segment(size * c, size);
  return solution;
}

void SupernodalFactors::solve(const Vector& right_hand_side, Vector& solution) const {
  set_owned_entries(solve(Columns(owned_entries(right_hand_side))), solution);
}

FactorCost SupernodalFactors::cost() const {
  FactorCost cost;
  for (const auto& shape : layout_.panels) {
    for (double rows = shape.n_rows; rows > shape.n_below(); --rows) {
      cost.entries += rows;
      cost.operations += rows * rows;
    }
  }
  const std::size_t numbers = factor_.size() + stacks_[0].size() + stacks_[1].size();
  cost.memory_mib = static_cast<double>(numbers * sizeof(double)) / 1048576.;
  return cost;
}

}  // namespace vibrissa::fem
