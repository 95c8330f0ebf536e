#include "separation/frequency_problem.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "separation/mode_step.h"
#include "signals/error.h"
#include "signals/number_text.h"

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
                    std::to_string(response.standard_deviation.size()) + " standard deviations");
}

std::vector<double> averaged_variance(const std::vector<double>& standard_deviation) {
  constexpr std::ptrdiff_t reach = 5;
  const auto n = static_cast<std::ptrdiff_t>(standard_deviation.size());
  std::vector<double> variance(standard_deviation.size());
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, k - reach);
    const std::ptrdiff_t end = std::min(n, k + reach + 1);
    double sum = 0.;
    for (std::ptrdiff_t i = first; i < end; ++i)
      sum += std::pow(standard_deviation[static_cast<std::size_t>(i)], 2);
    const double own = std::pow(standard_deviation[static_cast<std::size_t>(k)], 2);
    variance[static_cast<std::size_t>(k)] =
        0.5 * own + 0.5 * sum / static_cast<double>(end - first);
  }
  return variance;
}

}  // namespace

FrequencyProblem::FrequencyProblem(const signals::FrequencyResponse& response,
                                   std::optional<Sampling> sampling, bool direct_term,
                                   double delay_s)
    : sampling_(sampling), direct_term_(direct_term), delay_s_(delay_s) {
  if (sampling_) {
    highest_damped_rad_s_ = separation::highest_rad_s(sampling_->hold, sampling_->rate_hz);
    // The samples of a band-limited signal are as good as the signal.
    if (sampling_->hold == Hold::band_limited) sampling_.reset();
  }
  check_lengths(response);
  take_lines(response);
}

void FrequencyProblem::take_lines(const signals::FrequencyResponse& response) {
  SampledDelay delay;
  if (sampling_) delay = sampled_delay(delay_s_, sampling_->rate_hz);
  fraction_ = delay.fraction;
  std::vector<double> deviation;
  for (std::size_t k = 0; k < response.value.size(); ++k) {
    const double f = response.frequency_hz[k];
    const Complex value = response.value[k];
    if (!std::isfinite(value.real()) || !std::isfinite(value.imag())) continue;
    if (!std::isfinite(f) || f < 0. ||
        (!s_.empty() && !(2. * std::numbers::pi * f > s_.back().imag())))
      throw UserError("frequency fit: frequency " + std::to_string(k + 1) + ", " +
                      signals::to_text(f) + " Hz, is not above the one before it");
    const Complex s(0., 2. * std::numbers::pi * f);
    s_.push_back(s);
    measured_.push_back(value);
    deviation.push_back(response.standard_deviation.empty()
                            ? std::numeric_limits<double>::quiet_NaN()
                            : response.standard_deviation[k]);
    if (sampling_) {
      const Complex one = std::exp(-s / sampling_->rate_hz);
      const bool steps = sampling_->hold == Hold::zero_order;
      const double older = fraction_ == 0. ? 0. : steps ? 1. : fraction_;
      one_sample_.push_back(one);
      delay_factor_.push_back(std::pow(one, static_cast<int>(delay.shift)));
      direct_factor_.push_back(1. - older + older * one);
    } else {
      one_sample_.push_back(1.);
      delay_factor_.push_back(std::exp(-s * delay_s_));
      direct_factor_.push_back(1.);
    }
  }
  if (s_.size() < 3)
    throw UserError("frequency fit: only " + std::to_string(s_.size()) +
                    " lines have a finite value; at least 3 are needed");
  weigh(deviation);
}

void FrequencyProblem::weigh(const std::vector<double>& standard_deviation) {
  const bool known = std::ranges::all_of(standard_deviation,
                                         [](double sd) { return std::isfinite(sd) && sd >= 0.; });
  double power = 0.;
  for (const Complex& value : measured_) power += std::norm(value);
  power /= static_cast<double>(n_lines());
  if (!(power > 0.)) throw UserError("frequency fit: the measured response is zero at every line");
  root_weight_.assign(n_lines(), std::sqrt(2. / power));
  if (known) {
    // No line is known better than rounding allows.
    const std::vector<double> variance = averaged_variance(standard_deviation);
    for (std::size_t k = 0; k < n_lines(); ++k)
      root_weight_[k] = std::sqrt(2. / (variance[k] + 1e-16 * power));
  }
  total_ = 0.;
  for (std::size_t k = 0; k < n_lines(); ++k) total_ += std::norm(root_weight_[k] * measured_[k]);
}

bool FrequencyProblem::admissible(const ModalTerm& mode) const {
  if (!(mode.a1 > 0. && mode.a0 > 0.)) return false;
  const double damped_square = mode.a0 - 0.25 * mode.a1 * mode.a1;
  return damped_square < std::pow(highest_damped_rad_s_, 2);
}

void FrequencyProblem::evaluate(const Eigen::VectorXd& parameters, Eigen::VectorXd& residual,
                                Eigen::MatrixXd* jacobian) const {
  const Bvrm model = with_parameters(parameters, direct_term_, delay_s_);
  const auto n = static_cast<Eigen::Index>(n_lines());
  std::vector<Complex> remaining = measured_;
  Eigen::Index column = 0;
  const auto fill = [&](Eigen::Index j, std::size_t line, Complex value) {
    const auto row = static_cast<Eigen::Index>(line);
    (*jacobian)(row, j) = root_weight_[line] * value.real();
    (*jacobian)(row + n, j) = root_weight_[line] * value.imag();
  };
  for (const ModalTerm& mode : model.modes) {
    std::optional<ModeStep> step;
    if (sampling_) step.emplace(mode.a1, mode.a0, sampling_->rate_hz, sampling_->hold, fraction_);
    for (std::size_t k = 0; k < n_lines(); ++k) {
      const SensitiveResponse g =
          step ? sampled_mode_response(mode, *step, one_sample_[k]) : mode_response(mode, s_[k]);
      remaining[k] -= g.value * delay_factor(k);
      if (!jacobian) continue;
      for (std::size_t j = 0; j < g.derivative.size(); ++j)
        fill(column + static_cast<Eigen::Index>(j), k, g.derivative[j] * delay_factor(k));
    }
    column += parameters_per_mode;
  }
  residual.resize(2 * n);
  for (std::size_t k = 0; k < n_lines(); ++k) {
    const Complex direct = direct_factor_[k] * delay_factor(k);
    remaining[k] -= model.direct_term_kg_m * direct;
    if (jacobian && direct_term_) fill(column, k, direct);
    const auto row = static_cast<Eigen::Index>(k);
    residual[row] = root_weight_[k] * remaining[k].real();
    residual[row + n] = root_weight_[k] * remaining[k].imag();
  }
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
  const ModalTerm mode{.b1 = 0., .b0 = 0., .a1 = a1, .a0 = a0};
  std::optional<ModeStep> step;
  if (sampling_) step.emplace(a1, a0, sampling_->rate_hz, sampling_->hold, fraction_);
  const auto n = static_cast<Eigen::Index>(n_lines());
  Eigen::MatrixXd columns(2 * n, 2);
  for (std::size_t k = 0; k < n_lines(); ++k) {
    const SensitiveResponse g =
        step ? sampled_mode_response(mode, *step, one_sample_[k]) : mode_response(mode, s_[k]);
    for (Eigen::Index j = 0; j < 2; ++j) {
      const Complex value =
          root_weight_[k] * g.derivative[static_cast<std::size_t>(j)] * delay_factor(k);
      columns(static_cast<Eigen::Index>(k), j) = value.real();
      columns(static_cast<Eigen::Index>(k) + n, j) = value.imag();
    }
  }
  return columns;
}

Eigen::VectorXd FrequencyProblem::direct_column() const {
  const auto n = static_cast<Eigen::Index>(n_lines());
  Eigen::VectorXd column(2 * n);
  for (std::size_t k = 0; k < n_lines(); ++k) {
    const Complex value = root_weight_[k] * direct_factor_[k] * delay_factor(k);
    column[static_cast<Eigen::Index>(k)] = value.real();
    column[static_cast<Eigen::Index>(k) + n] = value.imag();
  }
  return column;
}

Eigen::VectorXd FrequencyProblem::with_best_gains(const std::vector<ModalTerm>& poles) const {
  const auto n_modes = static_cast<Eigen::Index>(poles.size());
  Eigen::MatrixXd columns(n_residuals(), 2 * n_modes + (direct_term_ ? 1 : 0));
  for (Eigen::Index k = 0; k < n_modes; ++k) {
    const ModalTerm& mode = poles[static_cast<std::size_t>(k)];
    columns.middleCols(2 * k, 2) = gain_columns(mode.a1, mode.a0);
  }
  if (direct_term_) columns.rightCols(1) = direct_column();
  if (columns.cols() == 0) return {};
  const Eigen::VectorXd measured =
      residual(Eigen::VectorXd::Zero(direct_term_ ? 1 : 0));  // of a model without modes
  // The columns differ by powers of the frequency; equal lengths let the rank be judged.
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
