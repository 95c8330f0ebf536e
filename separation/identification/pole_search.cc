#include "separation/identification/pole_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <utility>

namespace vibrissa::separation {

namespace {

using Complex = std::complex<double>;

// Poles in units of the highest frequency: real ones, and of each complex pair the upper one.
struct PoleSet {
  std::vector<double> real;
  std::vector<Complex> upper;
  Eigen::Index size() const { return static_cast<Eigen::Index>(real.size() + 2 * upper.size()); }
};

PoleSet spread_poles(double lowest, std::size_t n_modes) {
  PoleSet poles;
  for (std::size_t k = 0; k < n_modes; ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(n_modes);
    const double omega = lowest + share * (1. - lowest);
    poles.upper.emplace_back(-0.01 * omega, omega);
  }
  return poles;
}

// Partial fractions with real coefficients.
Eigen::RowVectorXcd fractions(const PoleSet& poles, Complex s) {
  Eigen::RowVectorXcd row(poles.size());
  Eigen::Index i = 0;
  for (const double p : poles.real) row[i++] = 1. / (s - p);
  for (const Complex& p : poles.upper) {
    const Complex up = 1. / (s - p), down = 1. / (s - std::conj(p));
    row[i++] = up + down;
    row[i++] = Complex(0., 1.) * (up - down);
  }
  return row;
}

// Zeros of d + sum c_i fraction_i: eigenvalues of A - b c^T / d for the realisation of the
// fractions.
Eigen::VectorXcd zeros(const PoleSet& poles, const Eigen::VectorXd& c, double d) {
  const Eigen::Index n = poles.size();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd b(n);
  Eigen::Index i = 0;
  for (const double p : poles.real) {
    a(i, i) = p;
    b[i++] = 1.;
  }
  for (const Complex& p : poles.upper) {
    a.block<2, 2>(i, i) << p.real(), p.imag(), -p.imag(), p.real();
    b.segment<2>(i) << 2., 0.;
    i += 2;
  }
  return (a - b * c.transpose() / d).eigenvalues();
}

PoleSet stable_poles(const Eigen::VectorXcd& values) {
  PoleSet poles;
  for (const Complex& value : values) {
    // A pole on the axis would make a fraction infinite at a line.
    const double reach = std::max(std::abs(value), 1e-6);
    const double real = -std::max(std::abs(value.real()), 1e-5 * reach);
    if (std::abs(value.imag()) <= 1e-9 * reach)
      poles.real.push_back(real);
    else if (value.imag() > 0.)
      poles.upper.emplace_back(real, value.imag());
  }
  std::ranges::sort(poles.real);
  std::ranges::sort(poles.upper, {}, [](const Complex& p) { return std::abs(p); });
  return poles;
}

PoleSet relocate(const FrequencyProblem& problem, const PoleSet& poles) {
  const Eigen::Index n_lines = problem.n_lines();
  const Eigen::Index n = poles.size(), n_direct = problem.direct_term() ? 1 : 0;
  Eigen::MatrixXcd rows(n_lines, 2 * n + n_direct + 1);
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(rows.cols());
  for (Eigen::Index k = 0; k < n_lines; ++k) {
    const Complex s = problem.s()[k];
    const Complex undelayed = problem.measured()[k] * std::exp(s * problem.delay_s());
    const double weight = problem.root_weight()[k];
    const Eigen::RowVectorXcd row = fractions(poles, s / problem.highest_rad_s());
    rows.row(k).head(n) = weight * row;
    if (n_direct) rows(k, n) = weight;
    rows.row(k).segment(n + n_direct, n) = -weight * undelayed * row;
    rows(k, 2 * n + n_direct) = -weight * undelayed;
    mean.segment(n + n_direct, n) += row.real();
  }
  mean /= static_cast<double>(n_lines);
  mean[2 * n + n_direct] = 1.;

  Eigen::MatrixXd matrix(2 * n_lines + 1, rows.cols());
  matrix << rows.real(), rows.imag(), std::sqrt(problem.total()) * mean;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(matrix.rows());
  right[right.size() - 1] = std::sqrt(problem.total());
  const Eigen::VectorXd length = matrix.colwise().norm();
  matrix.array().rowwise() /= length.transpose().array();
  const Eigen::VectorXd x = matrix.colPivHouseholderQr().solve(right).cwiseQuotient(length);
  const double smallest = 1e-8;
  double d = x[x.size() - 1];
  if (std::abs(d) < smallest) d = std::copysign(smallest, d);
  return stable_poles(zeros(poles, x.segment(n + n_direct, n), d));
}

// Largest relative move of a pole; infinite when pairs have become real or the other way round.
double distance(const PoleSet& before, const PoleSet& after) {
  if (before.upper.size() != after.upper.size()) return std::numeric_limits<double>::infinity();
  double largest = 0.;
  for (std::size_t i = 0; i < after.upper.size(); ++i)
    largest =
        std::max(largest, std::abs(after.upper[i] - before.upper[i]) / std::abs(after.upper[i]));
  for (std::size_t i = 0; i < after.real.size(); ++i)
    largest = std::max(largest, std::abs(after.real[i] - before.real[i]) / std::abs(after.real[i]));
  return largest;
}

std::vector<ModalTerm> pairs(const PoleSet& poles, double unit_rad_s) {
  std::vector<ModalTerm> modes;
  for (const Complex& p : poles.upper)
    modes.push_back(
        {.a1 = -2. * p.real() * unit_rad_s, .a0 = std::norm(p) * unit_rad_s * unit_rad_s});
  for (std::size_t i = 0; i + 1 < poles.real.size(); i += 2)
    modes.push_back({.a1 = -(poles.real[i] + poles.real[i + 1]) * unit_rad_s,
                     .a0 = poles.real[i] * poles.real[i + 1] * unit_rad_s * unit_rad_s});
  return modes;
}

// Lines with the largest residual in their neighbourhood, and others spread over the band.
std::vector<double> candidate_rad_s(const FrequencyProblem& problem,
                                    const Eigen::VectorXd& residual) {
  constexpr Eigen::Index n_spread = 24;
  constexpr std::size_t n_peaks = 8;
  const Eigen::Index n = problem.n_lines();
  const Eigen::ArrayXd power =
      residual.head(n).array().square() + residual.tail(n).array().square();
  std::vector<Eigen::Index> lines;
  for (Eigen::Index k = 0; k < n; ++k) {
    const bool above_left = k == 0 || power[k] >= power[k - 1];
    const bool above_right = k + 1 == n || power[k] > power[k + 1];
    if (above_left && above_right) lines.push_back(k);
  }
  std::ranges::sort(lines, std::greater<>(), [&](Eigen::Index k) { return power[k]; });
  lines.resize(std::min(lines.size(), n_peaks));
  for (Eigen::Index i = 0; i < n_spread; ++i) lines.push_back(i * (n - 1) / (n_spread - 1));
  std::ranges::sort(lines);
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  std::vector<double> omega;
  for (const Eigen::Index k : lines)
    if (problem.s()[k].imag() > 0.) omega.push_back(problem.s()[k].imag());
  return omega;
}

// Orthonormal columns that span what the gains of a fitted model can do.
Eigen::MatrixXd adaptable_space(const FrequencyProblem& problem, const Bvrm& model) {
  Eigen::MatrixXd columns(problem.n_residuals(), static_cast<Eigen::Index>(model.order()) +
                                                     (problem.direct_term() ? 1 : 0));
  Eigen::Index i = 0;
  for (const ModalTerm& mode : model.modes) {
    columns.middleCols(i, 2) = problem.gain_columns(mode.a1, mode.a0);
    i += 2;
  }
  if (problem.direct_term()) columns.rightCols(1) = problem.direct_column();
  if (columns.cols() == 0) return columns;
  columns.colwise().normalize();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
}

// How much of the residual two more columns take, the other gains adapting.
double gain_of(Eigen::MatrixXd columns, const Eigen::MatrixXd& space,
               const Eigen::VectorXd& residual) {
  columns.colwise().normalize();
  columns -= space * (space.transpose() * columns);
  double gain = 0.;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    if (j > 0) columns.col(j) -= columns.col(0) * columns.col(0).dot(columns.col(j));
    const double length = columns.col(j).norm();
    if (length < 1e-6) continue;
    columns.col(j) /= length;
    gain += std::pow(columns.col(j).dot(residual), 2);
  }
  return gain;
}

}  // namespace

std::vector<ModalTerm> vector_fitting_poles(const FrequencyProblem& problem, std::size_t n_modes) {
  constexpr int n_iterations = 12;
  PoleSet poles = spread_poles(problem.s()[0].imag() / problem.highest_rad_s(), n_modes);
  for (int i = 0; i < n_iterations; ++i) {
    PoleSet next = relocate(problem, poles);
    const bool settled = distance(poles, next) < 1e-4;
    poles = std::move(next);
    if (settled) break;
  }
  return pairs(poles, problem.highest_rad_s());
}

std::vector<ModalTerm> promising_modes(const FrequencyProblem& problem,
                                       const Eigen::VectorXd& parameters, std::size_t n_places) {
  const Bvrm model = with_parameters(parameters, problem.direct_term(), problem.delay_s());
  const Eigen::VectorXd residual = problem.residual(parameters);
  const Eigen::MatrixXd space = adaptable_space(problem, model);
  struct Candidate {
    ModalTerm mode;
    double gain;
  };
  std::vector<Candidate> best;
  for (const double omega : candidate_rad_s(problem, residual)) {
    Candidate here{.mode = {}, .gain = -1.};
    for (const double zeta : {0.01, 0.05, 0.25}) {
      const ModalTerm mode{.a1 = 2. * zeta * omega, .a0 = omega * omega};
      if (!problem.admissible(mode)) continue;
      const double gain = gain_of(problem.gain_columns(mode.a1, mode.a0), space, residual);
      if (gain > here.gain) here = {mode, gain};
    }
    if (here.gain >= 0.) best.push_back(here);
  }
  std::ranges::sort(best, std::greater<>(), &Candidate::gain);
  std::vector<ModalTerm> places;
  for (const Candidate& candidate : best) {
    if (places.size() == n_places) break;
    places.push_back(candidate.mode);
  }
  return places;
}

}  // namespace vibrissa::separation
