#include "fem/solid/cell_elasticity.h"

#include <cmath>
#include <limits>

namespace vibrissa::fem {

namespace {

using materials::load;
using materials::Register;
using materials::register_size;
using materials::store;

constexpr int row = CellIntegrals::row;
constexpr int n_points = CellIntegrals::n_points;
constexpr int n_linear = CellIntegrals::n_linear;
constexpr int n_registers = row / register_size;
constexpr int n_rows = 3 * n_points;  // of the gradient

// Symmetric tensors as in deal.II: 11, 22, 33, 12, 13, 23.
constexpr int voigt[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
// Place of an entry of the upper triangle of a symmetric 6 x 6 matrix.
constexpr int upper(const int m, const int n) {
  return m <= n ? m * (11 - m) / 2 + n : upper(n, m);
}

double sum(const Register& x) {
  using Half [[gnu::vector_size(sizeof(Register) / 2)]] = double;
  const Half half =
      __builtin_shufflevector(x, x, 0, 1, 2, 3) + __builtin_shufflevector(x, x, 4, 5, 6, 7);
  return (half[0] + half[1]) + (half[2] + half[3]);
}

double weighted_sum(const double* weight, const double* x) {
  Register total{};
  for (int r = 0; r < row; r += register_size) {
    Register w, v;
    load(w, weight + r);
    load(v, x + r);
    total += w * v;
  }
  return sum(total);
}

/// out[c][node] = sum over rows k of gradient[k][node] factor[k][c].
template <int n>
void sum_rows(const double* gradient, const double (*factor)[n], double* out) {
  Register total[n][n_registers] = {};
  for (int k = 0; k < n_rows; ++k) {
    Register g[n_registers];
    for (int r = 0; r < n_registers; ++r) load(g[r], gradient + row * k + register_size * r);
    for (int c = 0; c < n; ++c) {
      for (int r = 0; r < n_registers; ++r) total[c][r] += g[r] * factor[k][c];
    }
  }
  for (int c = 0; c < n; ++c) {
    for (int r = 0; r < n_registers; ++r) store(total[c][r], out + row * c + register_size * r);
  }
}

/// Forces of nominal stresses, [3 component + direction][point], times the weights.
void forces_of_stress(const CellIntegrals& cell, const double* stress, CellElasticity::Nodal& f) {
  double factor[n_rows][3];
  for (int q = 0; q < n_points; ++q) {
    for (int d = 0; d < 3; ++d) {
      for (int a = 0; a < 3; ++a) {
        factor[3 * q + d][a] = cell.weight[q] * stress[(3 * a + d) * row + q];
      }
    }
  }
  alignas(64) double nodal[3 * row];
  sum_rows<3>(cell.gradient.data(), factor, nodal);
  for (int node = 0; node < CellIntegrals::n_nodes; ++node) {
    for (int a = 0; a < 3; ++a) f[3 * node + a] = nodal[a * row + node];
  }
}

/// x projected to the linear functions, at the points.
void project(const CellIntegrals& cell, const double* x, double* projected) {
  double coefficient[n_linear];
  for (int m = 0; m < n_linear; ++m) {
    alignas(64) double product[row];
    for (int q = 0; q < row; ++q) product[q] = cell.psi[row * m + q] * x[q];
    coefficient[m] = weighted_sum(cell.weight.data(), product) / cell.volume;
  }
  for (int q = 0; q < row; ++q) {
    double value = 0.;
    for (int m = 0; m < n_linear; ++m) value += coefficient[m] * cell.psi[row * m + q];
    projected[q] = value;
  }
}

}  // namespace

double CellElasticity::deform(const CellIntegrals& cell, const materials::Material& material,
                              const Nodal& u) {
  cell_ = &cell;
  material_ = &material;
  modulus_factor_ = 1.;
  fill_gradient(u);
  fill_volume_change();
  for (int q = 0; q < n_points; ++q) {
    if (!(j_minus_1_[q] > -1.)) return std::numeric_limits<double>::quiet_NaN();
  }
  return fill_isochoric() + fill_pressure();
}

void CellElasticity::relax(const double factor, const Stress& constant) {
  modulus_factor_ = factor;
  for (std::size_t i = 0; i < stress_.size(); ++i) stress_[i] = factor * stress_[i] + constant[i];
}

void CellElasticity::set_stress_of(const CellElasticity& other) {
  stress_ = other.stress_;
  pressure_ = other.pressure_;
}

void CellElasticity::fill_gradient(const Nodal& u) {
  alignas(64) double component[3][row] = {};
  for (int node = 0; node < n_nodes; ++node) {
    for (int a = 0; a < 3; ++a) component[a][node] = u[3 * node + a];
  }
  Register values[3][n_registers];
  for (int a = 0; a < 3; ++a) {
    for (int r = 0; r < n_registers; ++r) load(values[a][r], component[a] + register_size * r);
  }
  h_.fill(0.);
  for (int q = 0; q < n_points; ++q) {
    for (int d = 0; d < 3; ++d) {
      const double* gradient = cell_->gradient.data() + row * (3 * q + d);
      Register total[3] = {};
      for (int r = 0; r < n_registers; ++r) {
        Register g;
        load(g, gradient + register_size * r);
        for (int a = 0; a < 3; ++a) total[a] += g * values[a][r];
      }
      for (int a = 0; a < 3; ++a) h_[(3 * a + d) * row + q] = sum(total[a]);
    }
  }
}

// J - 1 = tr h + second invariant + det h: no difference of numbers near one.
void CellElasticity::fill_volume_change() {
  const auto h = [this](const int a, const int d, const int q) {
    return h_[(3 * a + d) * row + q];
  };
  for (int q = 0; q < row; ++q) {
    double minor[3][3];
    for (int a = 0; a < 3; ++a) {
      for (int d = 0; d < 3; ++d) {
        const int b = (a + 1) % 3, c = (a + 2) % 3, e = (d + 1) % 3, f = (d + 2) % 3;
        minor[a][d] = h(b, e, q) * h(c, f, q) - h(b, f, q) * h(c, e, q);
      }
    }
    const double trace = h(0, 0, q) + h(1, 1, q) + h(2, 2, q);
    const double determinant =
        h(0, 0, q) * minor[0][0] + h(0, 1, q) * minor[0][1] + h(0, 2, q) * minor[0][2];
    j_minus_1_[q] = trace + (minor[0][0] + minor[1][1] + minor[2][2]) + determinant;
    // The cofactor of I + h: (1 + tr h) I - h^T + cofactor of h.
    for (int a = 0; a < 3; ++a) {
      for (int d = 0; d < 3; ++d) {
        cofactor_[(3 * a + d) * row + q] = minor[a][d] - h(d, a, q) + (a == d ? 1. + trace : 0.);
      }
    }
  }
}

// E = (h + h^T + h^T h)/2, which keeps the digits of a small h.
void CellElasticity::fill_strain() {
  constexpr int first[6] = {0, 1, 2, 0, 0, 1}, second[6] = {0, 1, 2, 1, 2, 2};
  for (int m = 0; m < 6; ++m) {
    const int i = first[m], j = second[m];
    for (int q = 0; q < row; ++q) {
      double value = h_[(3 * i + j) * row + q] + h_[(3 * j + i) * row + q];
      for (int a = 0; a < 3; ++a) value += h_[(3 * a + i) * row + q] * h_[(3 * a + j) * row + q];
      strain_[m * row + q] = 0.5 * value;
    }
  }
}

double CellElasticity::fill_isochoric() {
  fill_strain();
  Register total{};
  for (int start = 0; start < row; start += register_size) {
    Register e[6], energy, stress[6], weight;
    for (int m = 0; m < 6; ++m) load(e[m], strain_.data() + m * row + start);
    materials::isochoric_stress(material_->isochoric, e, energy, stress);
    for (int m = 0; m < 6; ++m) store(stress[m], stress_.data() + m * row + start);
    load(weight, cell_->weight.data() + start);
    total += weight * energy;
  }
  return sum(total);
}

double CellElasticity::fill_pressure() {
  const materials::VolumetricLaw& law = material_->volumetric;
  double energy = 0.;
  alignas(64) PointValues<1> at_points{};
  project(*cell_, j_minus_1_.data(), theta_minus_1_.data());
  for (int q = 0; q < n_points; ++q) {
    energy += cell_->weight[q] * law.energy(theta_minus_1_[q]);
    at_points[q] = law.pressure(theta_minus_1_[q]);
  }
  project(*cell_, at_points.data(), pressure_.data());
  return energy;
}

// P = F S + p dJ/dF.
void CellElasticity::force(Nodal& f) const {
  alignas(64) PointValues<9> nominal;
  for (int a = 0; a < 3; ++a) {
    for (int d = 0; d < 3; ++d) {
      for (int q = 0; q < n_points; ++q) {
        double value =
            stress_[voigt[a][d] * row + q] + pressure_[q] * cofactor_[(3 * a + d) * row + q];
        for (int k = 0; k < 3; ++k) {
          value += h_[(3 * a + k) * row + q] * stress_[voigt[k][d] * row + q];
        }
        nominal[(3 * a + d) * row + q] = value;
      }
    }
  }
  forces_of_stress(*cell_, nominal.data(), f);
}

void CellElasticity::fill_moduli() {
  for (int start = 0; start < row; start += register_size) {
    Register e[6], tangent[n_moduli];
    for (int m = 0; m < 6; ++m) load(e[m], strain_.data() + m * row + start);
    materials::isochoric_tangent(material_->isochoric, e, tangent);
    for (int m = 0; m < n_moduli; ++m) {
      tangent[m] *= modulus_factor_;
      store(tangent[m], moduli_.data() + m * row + start);
    }
  }
}

// dP_aI/dF_bJ at constant pressure, times the weight, for a <= b, [9 pair + 3 I + J]:
// F_aK C_KILJ F_bL + delta_ab S_IJ + p e_abc e_IJK F_cK.
void CellElasticity::fill_first_moduli(PointValues<54>& moduli) const {
  constexpr int third[3][3] = {{-1, 2, 1}, {2, -1, 0}, {1, 0, -1}};
  for (int start = 0; start < row; start += register_size) {
    const auto at = [start](const auto& values, const int quantity, Register& lanes) {
      load(lanes, values.data() + quantity * row + start);
    };
    Register f[9], c[n_moduli], s[6], half[3][3][6], weight, pressure;
    for (int i = 0; i < 9; ++i) {
      at(h_, i, f[i]);
      if (i % 4 == 0) f[i] += 1.;
    }
    for (int i = 0; i < n_moduli; ++i) at(moduli_, i, c[i]);
    for (int i = 0; i < 6; ++i) at(stress_, i, s[i]);
    at(cell_->weight, 0, weight);
    at(pressure_, 0, pressure);
    for (int a = 0; a < 3; ++a) {
      for (int i = 0; i < 3; ++i) {
        for (int n = 0; n < 6; ++n) {
          half[a][i][n] = f[3 * a] * c[upper(voigt[0][i], n)] +
                          f[3 * a + 1] * c[upper(voigt[1][i], n)] +
                          f[3 * a + 2] * c[upper(voigt[2][i], n)];
        }
      }
    }
    int pair = 0;
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b, ++pair) {
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) {
            Register value = half[a][i][voigt[0][j]] * f[3 * b] +
                             half[a][i][voigt[1][j]] * f[3 * b + 1] +
                             half[a][i][voigt[2][j]] * f[3 * b + 2];
            if (a == b) {
              value += s[voigt[i][j]];
            } else if (i != j) {
              // e_abc for a < b is +1, -1, +1 for 01, 02, 12; e_ij. likewise, odd in i and j.
              const double sign = ((a + b) % 2 == 0 ? -1. : 1.) * ((i + j) % 2 == 0 ? -1. : 1.) *
                                  (i < j ? 1. : -1.);
              value += sign * pressure * f[3 * third[a][b] + third[i][j]];
            }
            value *= weight;
            store(value, moduli.data() + (9 * pair + 3 * i + j) * row + start);
          }
        }
      }
    }
  }
}

namespace {

constexpr int stride = CellElasticity::Blocks::stride;

/// right[3 q + I][27 pair + j] = sum over J of moduli_IJ gradient[3 q + J][j].
void fill_right_side(const CellIntegrals& cell, const double* moduli, double* right) {
  for (int q = 0; q < n_points; ++q) {
    Register g[3][n_registers];
    for (int d = 0; d < 3; ++d) {
      for (int r = 0; r < n_registers; ++r) {
        load(g[d][r], cell.gradient.data() + row * (3 * q + d) + register_size * r);
      }
    }
    for (int i = 0; i < 3; ++i) {
      // Ascending: the padding of a pair is overwritten by the next.
      for (int pair = 0; pair < CellElasticity::Blocks::n_pairs; ++pair) {
        const double* modulus = moduli + (9 * pair + 3 * i) * row + q;
        double* to = right + (3 * q + i) * stride + CellIntegrals::n_nodes * pair;
        for (int r = 0; r < n_registers; ++r) {
          const Register value =
              g[0][r] * modulus[0] + g[1][r] * modulus[row] + g[2][r] * modulus[2 * row];
          store(value, to + register_size * r);
        }
      }
    }
  }
}

/// out = gradient^T right in tiles that fit the processor's registers.
void multiply(const double* gradient, const double* right, double* out) {
  constexpr int tile_rows = 9, tile_registers = 3;
  for (int j = 0; j < stride; j += tile_registers * register_size) {
    for (int i = 0; i < CellIntegrals::n_nodes; i += tile_rows) {
      Register total[tile_rows][tile_registers] = {};
      for (int k = 0; k < n_rows; ++k) {
        Register x[tile_registers];
        for (int r = 0; r < tile_registers; ++r)
          load(x[r], right + stride * k + j + register_size * r);
        const double* g = gradient + row * k + i;
#pragma GCC unroll 9
        for (int a = 0; a < tile_rows; ++a) {
          for (int r = 0; r < tile_registers; ++r) total[a][r] += g[a] * x[r];
        }
      }
      for (int a = 0; a < tile_rows; ++a) {
        for (int r = 0; r < tile_registers; ++r) {
          store(total[a][r], out + stride * (i + a) + j + register_size * r);
        }
      }
    }
  }
}

}  // namespace

void CellElasticity::tangent(Blocks& blocks) {
  static_assert(stride % (3 * register_size) == 0 && n_nodes % 9 == 0, "whole tiles");
  fill_moduli();
  alignas(64) PointValues<54> moduli;
  fill_first_moduli(moduli);
  fill_right_side(*cell_, moduli.data(), right_side_.data());
  multiply(cell_->gradient.data(), right_side_.data(), blocks.values.data());
  add_volumetric(blocks);
}

// (d theta)^T U'' (d theta), d theta_m = 1/V int psi_m dJ/dF : grad du.
void CellElasticity::add_volumetric(Blocks& blocks) const {
  double factor[n_rows][6];
  alignas(64) double change[n_linear][3][row];
  for (int m = 0; m < n_linear; m += 2) {
    for (int q = 0; q < n_points; ++q) {
      for (int d = 0; d < 3; ++d) {
        for (int a = 0; a < 3; ++a) {
          const double value = cell_->weight[q] * cofactor_[(3 * a + d) * row + q];
          factor[3 * q + d][a] = value * cell_->psi[row * m + q];
          factor[3 * q + d][3 + a] = value * cell_->psi[row * (m + 1) + q];
        }
      }
    }
    sum_rows<6>(cell_->gradient.data(), factor, change[m][0]);
  }
  double modulus[n_linear][n_linear];
  alignas(64) double weight[row] = {};
  for (int q = 0; q < n_points; ++q) {
    weight[q] = cell_->weight[q] * material_->volumetric.tangent(theta_minus_1_[q]) /
                (cell_->volume * cell_->volume);
  }
  for (int m = 0; m < n_linear; ++m) {
    for (int n = 0; n < n_linear; ++n) {
      alignas(64) double product[row];
      for (int q = 0; q < row; ++q) {
        product[q] = cell_->psi[row * m + q] * cell_->psi[row * n + q];
      }
      modulus[m][n] = weighted_sum(weight, product);
    }
  }
  alignas(64) double work[n_linear][3][row];
  for (int m = 0; m < n_linear; ++m) {
    for (int a = 0; a < 3; ++a) {
      for (int i = 0; i < row; ++i) {
        double value = 0.;
        for (int n = 0; n < n_linear; ++n) value += modulus[m][n] * change[n][a][i];
        work[m][a][i] = value;
      }
    }
  }
  int pair = 0;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b, ++pair) {
      for (int i = 0; i < n_nodes; ++i) {
        double* to = blocks.values.data() + stride * i + n_nodes * pair;
        for (int j = 0; j < n_nodes; ++j) {
          double value = to[j];
          for (int m = 0; m < n_linear; ++m) value += change[m][a][i] * work[m][b][j];
          to[j] = value;
        }
      }
    }
  }
}

void CellElasticity::force_of_linear_model(const CellIntegrals& cell,
                                           const materials::Material& material, const Nodal& u,
                                           Nodal& f) {
  cell_ = &cell;
  material_ = &material;
  fill_gradient(u);
  const double bulk_modulus = material.volumetric.tangent(0.);
  const double two_mu = 2. * material.shear_modulus_at_rest();
  alignas(64) PointValues<1> dilatation;
  for (int q = 0; q < row; ++q) dilatation[q] = h_[q] + h_[4 * row + q] + h_[8 * row + q];
  project(cell, dilatation.data(), pressure_.data());
  alignas(64) PointValues<9> stress;
  for (int a = 0; a < 3; ++a) {
    for (int d = 0; d < 3; ++d) {
      for (int q = 0; q < row; ++q) {
        const double shear = 0.5 * (h_[(3 * a + d) * row + q] + h_[(3 * d + a) * row + q]);
        stress[(3 * a + d) * row + q] = two_mu * (shear - (a == d ? dilatation[q] / 3. : 0.)) +
                                        (a == d ? bulk_modulus * pressure_[q] : 0.);
      }
    }
  }
  forces_of_stress(cell, stress.data(), f);
}

}  // namespace vibrissa::fem
