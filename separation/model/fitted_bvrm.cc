#include "separation/model/fitted_bvrm.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace vibrissa::separation {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double deviation(const Eigen::Vector4d& derivative, const Eigen::Matrix4d& covariance) {
  return std::sqrt(derivative.dot(covariance * derivative));
}

ModeEstimate estimate(const ModalTerm& mode, const Eigen::Matrix4d& covariance) {
  const double f = mode.frequency_hz(), zeta = mode.damping_ratio(), gain = mode.static_gain_kg_m();
  const Eigen::Vector4d by_frequency(0., 0., 0., f / (2. * mode.a0));
  const Eigen::Vector4d by_damping(0., 0., zeta / mode.a1, -zeta / (2. * mode.a0));
  const Eigen::Vector4d by_gain(0., 1. / mode.a0, 0., -gain / mode.a0);
  return {.frequency_hz = {f, deviation(by_frequency, covariance)},
          .damping_ratio = {zeta, deviation(by_damping, covariance)},
          .static_gain_kg_m = {gain, deviation(by_gain, covariance)}};
}

// Positions of the parameters when the modes are sorted by frequency.
std::vector<Eigen::Index> ascending(const Eigen::VectorXd& parameters, bool direct_term) {
  const Eigen::Index n_modes = (parameters.size() - (direct_term ? 1 : 0)) / parameters_per_mode;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(n_modes));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {},
                    [&](Eigen::Index k) { return parameters[k * parameters_per_mode + 3]; });
  std::vector<Eigen::Index> positions;
  for (const Eigen::Index k : order)
    for (Eigen::Index j = 0; j < parameters_per_mode; ++j)
      positions.push_back(k * parameters_per_mode + j);
  if (direct_term) positions.push_back(parameters.size() - 1);
  return positions;
}

}  // namespace

Eigen::Index n_parameters(std::size_t n_modes, bool direct_term) {
  return parameters_per_mode * static_cast<Eigen::Index>(n_modes) + (direct_term ? 1 : 0);
}

Eigen::VectorXd to_parameters(const Bvrm& model, bool direct_term) {
  Eigen::VectorXd parameters(n_parameters(model.modes.size(), direct_term));
  Eigen::Index i = 0;
  for (const ModalTerm& mode : model.modes)
    for (const double value : {mode.b1, mode.b0, mode.a1, mode.a0}) parameters[i++] = value;
  if (direct_term) parameters[i] = model.direct_term_kg_m;
  return parameters;
}

Bvrm with_parameters(const Eigen::VectorXd& parameters, bool direct_term, double delay_s) {
  Bvrm model;
  model.delay_s = delay_s;
  const Eigen::Index n_modal = parameters.size() - (direct_term ? 1 : 0);
  assert(n_modal % parameters_per_mode == 0);
  for (Eigen::Index i = 0; i < n_modal; i += parameters_per_mode)
    model.modes.push_back({.b1 = parameters[i],
                           .b0 = parameters[i + 1],
                           .a1 = parameters[i + 2],
                           .a0 = parameters[i + 3]});
  if (direct_term) model.direct_term_kg_m = parameters[n_modal];
  return model;
}

FittedBvrm make_fitted(const Eigen::VectorXd& parameters, const Eigen::MatrixXd& covariance,
                       bool direct_term, double delay_s) {
  const std::vector<Eigen::Index> positions = ascending(parameters, direct_term);
  const Eigen::Index n = parameters.size();
  FittedBvrm fitted;
  fitted.model = with_parameters(parameters(positions), direct_term, delay_s);
  fitted.covariance = covariance.size() == 0 ? Eigen::MatrixXd::Constant(n, n, not_a_number)
                                             : Eigen::MatrixXd(covariance(positions, positions));
  for (std::size_t k = 0; k < fitted.model.modes.size(); ++k) {
    const auto first = parameters_per_mode * static_cast<Eigen::Index>(k);
    fitted.modes.push_back(
        estimate(fitted.model.modes[k], fitted.covariance.block<4, 4>(first, first)));
  }
  if (direct_term)
    fitted.direct_term_kg_m = {fitted.model.direct_term_kg_m,
                               std::sqrt(fitted.covariance(n - 1, n - 1))};
  return fitted;
}

}  // namespace vibrissa::separation
