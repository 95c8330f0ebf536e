#pragma once

#include <array>

#include "fem/solid/cell_integrals.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// Elastic energy, forces and stiffness of one cell at finite strain, total Lagrangian (T12):
///   W = int W_iso(E) + U(theta),  theta - 1 = J - 1 projected to the linear functions psi,
/// the three-field form Q2/DGP1 with pressure and theta condensed. The stiffness is the exact
/// second derivative of W; at rest it equals the stiffness of the linear model. Proven by
/// tests/fem/solid/cell_elasticity_test.cc.
class CellElasticity {
 public:
  static constexpr int n_nodes = CellIntegrals::n_nodes;
  using Nodal = std::array<double, 3 * n_nodes>;  // [3 node + component]

  /// Blocks of the stiffness for the pairs of components 00, 01, 02, 11, 12, 22, side by side:
  /// K(3 i + a, 3 j + b) = values[i stride + 27 pair(a, b) + j] for a <= b.
  struct Blocks {
    static constexpr int n_pairs = 6;
    static constexpr int stride = materials::padded(n_pairs * n_nodes);
    alignas(64) std::array<double, n_nodes * stride> values;
    const double* block(const int pair) const { return values.data() + n_nodes * pair; }
  };

  /// Energy [J] of the cell with the displacement u [m]; NaN when a point is inverted (det F <= 0)
  /// or the law is not defined. force() and tangent() then refer to this state.
  double deform(const CellIntegrals& cell, const materials::Material& material, const Nodal& u);
  /// Isochoric stress of the law at the points, [11, 22, 33, 12, 13, 23][point].
  using Stress = std::array<double, 6 * CellIntegrals::row>;
  const Stress& stress() const { return stress_; }
  /// Sets the stress to factor times the stress of the law plus a constant, and scales the moduli.
  void relax(double factor, const Stress& constant);
  /// Uses the stress and the pressure of another state of the same cell.
  void set_stress_of(const CellElasticity& other);
  /// dW/du [N].
  void force(Nodal& f) const;
  /// d2W/du2 [N/m].
  void tangent(Blocks& blocks);

  /// K u, K the tangent at rest: the derivative of force() there.
  void force_of_linear_model(const CellIntegrals& cell, const materials::Material& material,
                             const Nodal& u, Nodal& f);

 private:
  static constexpr int n_points = CellIntegrals::n_points;
  static constexpr int row = CellIntegrals::row;
  static constexpr int n_moduli = 21;
  template <int n>
  using PointValues = std::array<double, n * row>;  // [quantity][point]

  void fill_gradient(const Nodal& u);
  void fill_strain();
  void fill_volume_change();
  double fill_isochoric();
  double fill_pressure();
  void fill_moduli();
  void fill_first_moduli(PointValues<54>& moduli) const;
  void add_volumetric(Blocks& blocks) const;

  const CellIntegrals* cell_ = nullptr;
  const materials::Material* material_ = nullptr;
  alignas(64) PointValues<9> h_{};              // F - I, [3 component + direction]
  alignas(64) PointValues<9> cofactor_{};       // dJ/dF
  alignas(64) PointValues<1> j_minus_1_{};      // of F
  alignas(64) PointValues<1> theta_minus_1_{};  // projected
  alignas(64) PointValues<1> pressure_{};       // dU/dtheta, projected
  alignas(64) PointValues<6> strain_{};         // E, as the stress
  alignas(64) PointValues<6> stress_{};         // isochoric S in the order 11, 22, 33, 12, 13, 23
  double modulus_factor_ = 1.;
  alignas(64) PointValues<n_moduli> moduli_{};  // isochoric dS/dE, upper triangle
  alignas(
      64) std::array<double, 3 * n_points * Blocks::stride> right_side_{};  // moduli x gradients
};

}  // namespace vibrissa::fem
