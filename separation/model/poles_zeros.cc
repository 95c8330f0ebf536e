#include "separation/model/poles_zeros.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace vibrissa::separation {

namespace {

using Complex = std::complex<double>;
using Polynomial = Eigen::VectorXd;  // coefficient of s^i at i

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial result = Polynomial::Zero(a.size() + b.size() - 1);
  for (Eigen::Index i = 0; i < a.size(); ++i) result.segment(i, b.size()) += a[i] * b;
  return result;
}

// Numerator over the common denominator in s / unit; divided by unit^(2 n), as the denominator is.
Polynomial numerator(const Bvrm& model, double unit) {
  const auto n = static_cast<Eigen::Index>(model.modes.size());
  Polynomial sum = Polynomial::Zero(2 * n + 1), all = Polynomial::Ones(1);
  for (Eigen::Index k = 0; k < n; ++k) {
    const ModalTerm& mode = model.modes[static_cast<std::size_t>(k)];
    Polynomial term = Eigen::Vector2d(mode.b0 / (unit * unit), mode.b1 / unit);
    for (Eigen::Index j = 0; j < n; ++j) {
      const ModalTerm& other = model.modes[static_cast<std::size_t>(j)];
      const Eigen::Vector3d factor(other.a0 / (unit * unit), other.a1 / unit, 1.);
      if (j != k) term = product(term, factor);
      if (k == 0) all = product(all, factor);
    }
    sum.head(term.size()) += term;
  }
  sum += model.direct_term_kg_m * all;
  return sum;
}

std::vector<Complex> roots(Polynomial p) {
  const double size = p.cwiseAbs().maxCoeff();
  Eigen::Index degree = p.size() - 1;
  while (degree > 0 && std::abs(p[degree]) <= 1e-14 * size) --degree;
  std::vector<Complex> result;
  if (degree == 0) return result;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  companion.diagonal(-1).setOnes();
  companion.rightCols(1) = -p.head(degree) / p[degree];
  const Eigen::VectorXcd values = companion.eigenvalues();
  return {values.begin(), values.end()};
}

PlaneEstimate with_deviations(Complex value, const Eigen::RowVectorXcd& derivative,
                              const Eigen::MatrixXd& covariance) {
  const auto deviation = [&](const Eigen::RowVectorXd& d) {
    return std::sqrt((d * covariance * d.transpose()).value());
  };
  return {value, deviation(derivative.real()), deviation(derivative.imag())};
}

PlaneEstimate zero_estimate(const FittedBvrm& fit, Complex s) {
  const auto& modes = fit.model.modes;
  Eigen::RowVectorXcd by(fit.covariance.cols());
  Complex by_s = 0.;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const ModalTerm& mode = modes[k];
    const Complex inverse = 1. / (s * (s + mode.a1) + mode.a0);
    const Complex share = (mode.b1 * s + mode.b0) * inverse;
    by_s += inverse * (mode.b1 - share * (2. * s + mode.a1));
    by.segment<4>(parameters_per_mode * static_cast<Eigen::Index>(k)) << s * inverse, inverse,
        -s * share * inverse, -share * inverse;
  }
  if (by.size() % parameters_per_mode == 1) by[by.size() - 1] = 1.;
  return with_deviations(s, -by / by_s, fit.covariance);
}

void add_poles(const FittedBvrm& fit, std::size_t k, std::vector<PlaneEstimate>& poles) {
  const ModalTerm& mode = fit.model.modes[k];
  const Complex half = std::sqrt(Complex(0.25 * mode.a1 * mode.a1 - mode.a0));
  const auto first = parameters_per_mode * static_cast<Eigen::Index>(k) + 2;
  const Eigen::Matrix2d covariance = fit.covariance.block<2, 2>(first, first);
  for (const Complex pole : {-0.5 * mode.a1 + half, -0.5 * mode.a1 - half}) {
    if (pole.imag() < 0.) continue;
    const Eigen::RowVector2cd by(-pole / (2. * pole + mode.a1), -1. / (2. * pole + mode.a1));
    poles.push_back(with_deviations(pole, by, covariance));
  }
}

}  // namespace

PolesAndZeros poles_and_zeros(const FittedBvrm& fit) {
  PolesAndZeros result;
  double unit = 0.;
  for (std::size_t k = 0; k < fit.model.modes.size(); ++k) {
    add_poles(fit, k, result.poles);
    unit = std::max(unit, std::sqrt(fit.model.modes[k].a0));
  }
  if (fit.model.modes.empty()) return result;
  for (const Complex& root : roots(numerator(fit.model, unit)))
    if (root.imag() >= 0.) result.zeros.push_back(zero_estimate(fit, unit * root));
  const auto magnitude = [](const PlaneEstimate& point) { return std::abs(point.value); };
  std::ranges::sort(result.poles, {}, magnitude);
  std::ranges::sort(result.zeros, {}, magnitude);
  return result;
}

}  // namespace vibrissa::separation
