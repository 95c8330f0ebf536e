#include "separation/model/partial_fractions.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

namespace vibrissa::separation {

namespace {

using Complex = std::complex<double>;

struct PoleAndResidue {
  Complex pole, residue;
};

// States (w x, x') of every mode, for x'' + a1 x' + a0 x = u, w^2 = a0.
Eigen::MatrixXd free_motion(const std::vector<ModalTerm>& modes) {
  const auto n = 2 * static_cast<Eigen::Index>(modes.size());
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; 2 * k < n; ++k) {
    const ModalTerm& mode = modes[static_cast<std::size_t>(k)];
    const double omega = std::sqrt(mode.a0);
    motion.block<2, 2>(2 * k, 2 * k) << 0., omega, -omega, -mode.a1;
  }
  return motion;
}

// The row that gives sum_k (c1_k s + c0_k) / D_k from these states.
Eigen::RowVectorXd output_row(const std::vector<ModalTerm>& modes, const Eigen::VectorXd& c) {
  Eigen::RowVectorXd row(c.size());
  for (Eigen::Index k = 0; 2 * k < c.size(); ++k) {
    row[2 * k] = c[2 * k + 1] / std::sqrt(modes[static_cast<std::size_t>(k)].a0);
    row[2 * k + 1] = c[2 * k];
  }
  return row;
}

ModalTerm merge(const PoleAndResidue& one, const PoleAndResidue& other) {
  return {.b1 = (one.residue + other.residue).real(),
          .b0 = -(one.residue * other.pole + other.residue * one.pole).real(),
          .a1 = -(one.pole + other.pole).real(),
          .a0 = (one.pole * other.pole).real()};
}

std::vector<ModalTerm> pair_up(const std::vector<PoleAndResidue>& terms) {
  std::vector<ModalTerm> modes;
  std::vector<PoleAndResidue> real;
  for (const PoleAndResidue& term : terms) {
    if (term.pole.imag() > 0.)
      modes.push_back(merge(term, {std::conj(term.pole), std::conj(term.residue)}));
    if (term.pole.imag() == 0.) real.push_back(term);
  }
  std::ranges::sort(real, {}, [](const PoleAndResidue& term) { return term.pole.real(); });
  for (std::size_t i = 0; i + 1 < real.size(); i += 2) modes.push_back(merge(real[i], real[i + 1]));
  return modes;
}

}  // namespace

Bvrm quotient(const std::vector<ModalTerm>& modes, double direct_term,
              const Eigen::VectorXd& denominator) {
  const auto n = 2 * static_cast<Eigen::Index>(modes.size());
  Eigen::VectorXd numerator(n), input = Eigen::VectorXd::Zero(n);
  for (Eigen::Index k = 0; 2 * k < n; ++k) {
    numerator[2 * k] = modes[static_cast<std::size_t>(k)].b1;
    numerator[2 * k + 1] = modes[static_cast<std::size_t>(k)].b0;
    input[2 * k + 1] = 1.;
  }
  const Eigen::RowVectorXd feedback = output_row(modes, denominator);
  const Eigen::RowVectorXd output = output_row(modes, numerator) - direct_term * feedback;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(free_motion(modes) - input * feedback);
  const Eigen::MatrixXcd shapes = solver.eigenvectors();
  const Eigen::VectorXcd drive = shapes.partialPivLu().solve(input.cast<Complex>());
  const Eigen::RowVectorXcd gain = output.cast<Complex>() * shapes;
  std::vector<PoleAndResidue> terms;
  for (Eigen::Index i = 0; i < n; ++i)
    terms.push_back({solver.eigenvalues()[i], gain[i] * drive[i]});
  return {.modes = pair_up(terms), .direct_term_kg_m = direct_term};
}

}  // namespace vibrissa::separation
