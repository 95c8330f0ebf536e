#include "separation/identification/frequency_problem.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using Complex = std::complex<double>;
using signals::UserError;

void check_lengths(const signals::FrequencyResponse& response) {
  const std::size_t n = response.frequency_hz.size();
  if (response.value.size() != n ||
      (!response.standard_deviation.empty() && response.standard_deviation.size() != n))
    throw UserError("frequency fit: " + std::to_string(n) + " frequencies, " +
                    std::to_string(response.value.size()) + " values and " +
                    std::to_string(response.standard_deviation.size()) +
                    " standard deviations; all need the same length");
}

std::vector<double> averaged_variance(const std::vector<double>& standard_deviation) {
  constexpr std::ptrdiff_t reach = 5;
  const auto n = static_cast<std::ptrdiff_t>(standard_deviation.size());
  std::vector<double> variance;
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, k - reach);
    const std::ptrdiff_t end = std::min(n, k + reach + 1);
    double sum = 0.;
    for (std::ptrdiff_t i = first; i < end; ++i)
      sum += std::pow(standard_deviation[static_cast<std::size_t>(i)], 2);
    const double own = std::pow(standard_deviation[static_cast<std::size_t>(k)], 2);
    variance.push_back(0.5 * own + 0.5 * sum / static_cast<double>(end - first));
  }
  return variance;
}

// Without the overflow checks of a complex division: these values are near one, or near squares of
// angular frequencies.
Eigen::ArrayXcd reciprocal(const Eigen::ArrayXcd& z) {
  return z.conjugate() * z.abs2().inverse();
}

// Real parts above imaginary parts.
template <typename Column>
void stack(const Eigen::ArrayXcd& values, Column&& column) {
  column.head(values.size()) = values.real().matrix();
  column.tail(values.size()) = values.imag().matrix();
}

}  // namespace

// Weighted response of a mode at all lines, and its derivatives.
struct FrequencyProblem::ModeResponse {
  Eigen::ArrayXcd value, by_b1, by_b0, by_a1, by_a0;
};

FrequencyProblem::FrequencyProblem(const signals::FrequencyResponse& response,
                                   std::optional<Sampling> sampling, bool direct_term,
                                   double delay_s)
    : sampling_(sampling), direct_term_(direct_term), delay_s_(delay_s) {
  if (sampling_) {
    highest_damped_rad_s_ = separation::highest_rad_s(sampling_->hold, sampling_->rate_hz);
    // The samples of a band-limited signal determine the signal.
    if (sampling_->hold == Hold::band_limited) sampling_.reset();
  }
  if (sampling_) delay_ = sampled_delay(delay_s_, sampling_->rate_hz);
  check_lengths(response);
  take_lines(response);
}

void FrequencyProblem::take_lines(const signals::FrequencyResponse& response) {
  std::vector<double> omega, deviation;
  std::vector<Complex> value;
  for (std::size_t k = 0; k < response.value.size(); ++k) {
    if (!std::isfinite(response.value[k].real()) || !std::isfinite(response.value[k].imag()))
      continue;
    const double f = response.frequency_hz[k], w = 2. * std::numbers::pi * f;
    if (!std::isfinite(f) || f < 0. || (!omega.empty() && !(w > omega.back())))
      throw UserError("frequency fit: frequency " + std::to_string(k + 1) + ", " +
                      signals::to_text(f) + " Hz, is not above the frequency before it");
    omega.push_back(w);
    value.push_back(response.value[k]);
    deviation.push_back(response.standard_deviation.empty()
                            ? std::numeric_limits<double>::quiet_NaN()
                            : response.standard_deviation[k]);
  }
  if (omega.size() < 3)
    throw UserError("frequency fit: only " + std::to_string(omega.size()) +
                    " lines have a finite value; at least 3 are needed");
  const auto n = static_cast<Eigen::Index>(omega.size());
  s_ = Complex(0., 1.) * Eigen::Map<const Eigen::ArrayXd>(omega.data(), n);
  measured_ = Eigen::Map<const Eigen::ArrayXcd>(value.data(), n);
  weigh(deviation);
}

void FrequencyProblem::weigh(const std::vector<double>& standard_deviation) {
  const bool known = std::ranges::all_of(standard_deviation,
                                         [](double sd) { return std::isfinite(sd) && sd >= 0.; });
  const double power = measured_.abs2().mean();
  if (!(power > 0.)) throw UserError("frequency fit: the measured response is zero at every line");
  root_weight_ = Eigen::ArrayXd::Constant(n_lines(), std::sqrt(2. / power));
  if (known) {
    const std::vector<double> variance = averaged_variance(standard_deviation);
    // The deviation of a line is at least its rounding error.
    root_weight_ =
        (2. / (Eigen::Map<const Eigen::ArrayXd>(variance.data(), n_lines()) + 1e-16 * power))
            .sqrt();
  }
  total_ = (root_weight_ * measured_.abs()).square().sum();
  if (!sampling_) {
    gain_weight_ = root_weight_ * (-delay_s_ * s_).exp();
    direct_weight_ = gain_weight_;
    return;
  }
  const double sample_s = 1. / sampling_->rate_hz;
  for (std::size_t i = 0; i < late_.size(); ++i)
    late_[i] = (-(static_cast<double>(i + 1) * sample_s) * s_).exp();
  const bool steps = sampling_->hold == Hold::zero_order;
  const double older = delay_.fraction == 0. ? 0. : steps ? 1. : delay_.fraction;
  gain_weight_ = root_weight_ * (-(static_cast<double>(delay_.shift) * sample_s) * s_).exp();
  direct_weight_ = gain_weight_ * (1. - older + older * late_[0]);
}

bool FrequencyProblem::admissible(const ModalTerm& mode) const {
  return is_stable_below(mode, highest_damped_rad_s_);
}

FrequencyProblem::ModeResponse FrequencyProblem::mode_response(const ModalTerm& mode,
                                                               bool derivatives) const {
  ModeResponse g;
  if (!sampling_) {
    const Eigen::ArrayXcd receptance = reciprocal(s_ * (s_ + mode.a1) + mode.a0);
    g.by_b0 = gain_weight_ * receptance;
    g.by_b1 = s_ * g.by_b0;
    g.value = mode.b1 * g.by_b1 + mode.b0 * g.by_b0;
    if (!derivatives) return g;
    g.by_a0 = -g.value * receptance;
    g.by_a1 = s_ * g.by_a0;
    return g;
  }
  const ModeStep step(mode.a1, mode.a0, sampling_->rate_hz, sampling_->hold, delay_.fraction);
  const Eigen::ArrayXcd inverse =
      reciprocal(1. + step.pole1.value * late_[0] + step.pole2.value * late_[1]);
  const Eigen::ArrayXcd weighted = gain_weight_ * inverse;
  const auto polynomial = [&](const auto& tap) {
    return tap(0) + tap(1) * late_[0] + tap(2) * late_[1] + tap(3) * late_[2];
  };
  g.by_b1 = weighted * polynomial([&](std::size_t j) { return step.b1_taps[j].value; });
  g.by_b0 = weighted * polynomial([&](std::size_t j) { return step.b0_taps[j].value; });
  g.value = mode.b1 * g.by_b1 + mode.b0 * g.by_b0;
  if (!derivatives) return g;
  const auto by = [&](double Sensitive::*parameter) -> Eigen::ArrayXcd {
    return weighted * polynomial([&](std::size_t j) {
             return mode.b1 * step.b1_taps[j].*parameter + mode.b0 * step.b0_taps[j].*parameter;
           }) -
           g.value * inverse *
               (step.pole1.*parameter * late_[0] + step.pole2.*parameter * late_[1]);
  };
  g.by_a1 = by(&Sensitive::by_a1);
  g.by_a0 = by(&Sensitive::by_a0);
  return g;
}

void FrequencyProblem::evaluate(const Eigen::VectorXd& parameters, Eigen::VectorXd& residual,
                                Eigen::MatrixXd* jacobian) const {
  const Bvrm model = with_parameters(parameters, direct_term_, delay_s_);
  Eigen::ArrayXcd remaining = root_weight_ * measured_ - model.direct_term_kg_m * direct_weight_;
  Eigen::Index column = 0;
  for (const ModalTerm& mode : model.modes) {
    const ModeResponse g = mode_response(mode, jacobian != nullptr);
    remaining -= g.value;
    if (!jacobian) continue;
    for (const Eigen::ArrayXcd* derivative : {&g.by_b1, &g.by_b0, &g.by_a1, &g.by_a0})
      stack(*derivative, jacobian->col(column++));
  }
  if (jacobian && direct_term_) stack(direct_weight_, jacobian->col(column));
  residual.resize(n_residuals());
  stack(remaining, residual);
}

bool FrequencyProblem::linearise(const Eigen::VectorXd& parameters,
                                 NormalEquations& equations) const {
  const Bvrm model = with_parameters(parameters, direct_term_, delay_s_);
  if (!std::ranges::all_of(model.modes, [&](const ModalTerm& m) { return admissible(m); }))
    return false;
  Eigen::MatrixXd jacobian(n_residuals(), parameters.size());
  Eigen::VectorXd residual;
  evaluate(parameters, residual, &jacobian);
  equations.matrix.noalias() = jacobian.transpose() * jacobian;
  equations.gradient.noalias() = jacobian.transpose() * residual;
  equations.cost = residual.squaredNorm();
  return true;
}

Eigen::VectorXd FrequencyProblem::residual(const Eigen::VectorXd& parameters) const {
  Eigen::VectorXd residual;
  evaluate(parameters, residual, nullptr);
  return residual;
}

Eigen::MatrixXd FrequencyProblem::gain_columns(double a1, double a0) const {
  const ModeResponse g = mode_response({.b1 = 0., .b0 = 0., .a1 = a1, .a0 = a0}, false);
  Eigen::MatrixXd columns(n_residuals(), 2);
  stack(g.by_b1, columns.col(0));
  stack(g.by_b0, columns.col(1));
  return columns;
}

Eigen::VectorXd FrequencyProblem::direct_column() const {
  Eigen::VectorXd column(n_residuals());
  stack(direct_weight_, column);
  return column;
}

Eigen::VectorXd FrequencyProblem::with_best_gains(const std::vector<ModalTerm>& poles) const {
  const auto n_modes = static_cast<Eigen::Index>(poles.size());
  Eigen::MatrixXd columns(n_residuals(), 2 * n_modes + (direct_term_ ? 1 : 0));
  if (columns.cols() == 0) return {};
  for (Eigen::Index k = 0; k < n_modes; ++k) {
    const ModalTerm& mode = poles[static_cast<std::size_t>(k)];
    columns.middleCols(2 * k, 2) = gain_columns(mode.a1, mode.a0);
  }
  if (direct_term_) columns.rightCols(1) = direct_column();
  const Eigen::VectorXd measured =
      residual(Eigen::VectorXd::Zero(direct_term_ ? 1 : 0));  // of a model without modes
  // The columns differ by powers of the frequency; with equal lengths the rank can be determined.
  const Eigen::VectorXd length = columns.colwise().norm();
  columns.array().rowwise() /= length.transpose().array();
  const Eigen::VectorXd gain = columns.colPivHouseholderQr().solve(measured).cwiseQuotient(length);
  Eigen::VectorXd parameters(n_parameters(poles.size(), direct_term_));
  for (Eigen::Index k = 0; k < n_modes; ++k) {
    const ModalTerm& mode = poles[static_cast<std::size_t>(k)];
    parameters.segment<4>(parameters_per_mode * k) << gain[2 * k], gain[2 * k + 1], mode.a1,
        mode.a0;
  }
  if (direct_term_) parameters[parameters.size() - 1] = gain[gain.size() - 1];
  return parameters;
}

}  // namespace vibrissa::separation
