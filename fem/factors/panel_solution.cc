#include "fem/factors/panel_solution.h"

#include "fem/factors/blas.h"

namespace vibrissa::fem {

namespace {

constexpr double plus = 1., minus = -1., none = 0.;
constexpr int next = 1;

/// A panel of the factor and the unknowns of its columns.
struct PanelOnColumns {
  PanelOnColumns(const FrontLayout& layout, const double* factor, const std::size_t s, Columns& x)
      : n_columns(layout.panels[s].n_columns),
        n_below(layout.panels[s].n_below()),
        n_rows(layout.panels[s].n_rows),
        n_vectors(static_cast<int>(x.cols())),
        x_stride(static_cast<int>(x.rows())),
        diagonal(factor + layout.panels[s].start),
        rest(diagonal + n_columns),
        own(x.data() + layout.block_size * layout.supernodes.first[s]) {}

  void solve_diagonal(const char* transposed) const {
    if (n_vectors == 1) {
      dtrsv_("L", transposed, "N", &n_columns, diagonal, &n_rows, own, &next);
    } else {
      dtrsm_("L", "L", transposed, "N", &n_columns, &n_vectors, &plus, diagonal, &n_rows, own,
             &x_stride);
    }
  }
  /// below = rest * own
  void multiply_rest(double* below) const {
    if (n_vectors == 1) {
      dgemv_("N", &n_below, &n_columns, &plus, rest, &n_rows, own, &next, &none, below, &next);
    } else {
      dgemm_("N", "N", &n_below, &n_vectors, &n_columns, &plus, rest, &n_rows, own, &x_stride,
             &none, below, &n_below);
    }
  }
  /// own -= rest^T * below
  void take_rest_out(const double* below) const {
    if (n_vectors == 1) {
      dgemv_("T", &n_below, &n_columns, &minus, rest, &n_rows, below, &next, &plus, own, &next);
    } else {
      dgemm_("T", "N", &n_columns, &n_vectors, &n_below, &minus, rest, &n_rows, below, &n_below,
             &plus, own, &x_stride);
    }
  }

  int n_columns, n_below, n_rows, n_vectors, x_stride;
  const double *diagonal, *rest;
  double* own;
};

/// Calls action(unknown in x, the same below the panel) for all that lie below it.
template <class Action>
void for_below(const FrontLayout& layout, const std::size_t s, Columns& x, double* below,
               const Action& action) {
  const int n_nodes = layout.supernodes.n_below(s), size = layout.block_size;
  const int* const nodes = layout.supernodes.below(s);
  for (Eigen::Index vector = 0; vector < x.cols(); ++vector) {
    double* const column = x.col(vector).data();
    for (int k = 0; k < n_nodes; ++k) {
      double* const in_x = column + size * nodes[k];
      for (int a = 0; a < size; ++a) action(in_x[a], *below++);
    }
  }
}

}  // namespace

void solve_by_panels(const FrontLayout& layout, const double* const factor, Columns& x) {
  const std::size_t n = layout.panels.size();
  Columns below(x.rows(), x.cols());
  for (std::size_t s = 0; s < n; ++s) {
    const PanelOnColumns panel(layout, factor, s, x);
    panel.solve_diagonal("N");
    if (panel.n_below == 0) continue;
    panel.multiply_rest(below.data());
    for_below(layout, s, x, below.data(), [](double& in_x, const double b) { in_x -= b; });
  }
  for (std::size_t s = n; s-- > 0;) {
    const PanelOnColumns panel(layout, factor, s, x);
    if (panel.n_below > 0) {
      for_below(layout, s, x, below.data(), [](const double in_x, double& b) { b = in_x; });
      panel.take_rest_out(below.data());
    }
    panel.solve_diagonal("T");
  }
}

}  // namespace vibrissa::fem
