#include "separation/simulation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "separation/input_shaper.h"
#include "signals/error.h"
#include "signals/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

void check_rate(double sampling_rate_hz) {
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError("simulation: the sampling rate " + signals::to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
}

// Columns of the free responses of every mode (two each) and of the offset.
Eigen::MatrixXd nuisance_columns(const Bvrm& model, std::size_t n_samples, double sampling_rate_hz,
                                 const Nuisance& nuisance) {
  const auto n = static_cast<Eigen::Index>(n_samples);
  const Eigen::Index n_free =
      nuisance.initial_state ? 2 * static_cast<Eigen::Index>(model.modes.size()) : 0;
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, n_free + (nuisance.offset ? 1 : 0));
  for (Eigen::Index k = 0; 2 * k < n_free; ++k) {
    const ModalTerm& mode = model.modes[static_cast<std::size_t>(k)];
    const ModeStep step(mode.a1, mode.a0, sampling_rate_hz, Hold::first_order);
    auto impulse = columns.col(2 * k);
    impulse[0] = 1.;
    if (n > 1) impulse[1] = -step.pole1.value;
    // A response that has died out is zero: numbers near the smallest double would only cost time.
    for (Eigen::Index i = 2; i < n && std::abs(impulse[i - 1]) + std::abs(impulse[i - 2]) > 1e-100;
         ++i)
      impulse[i] = -step.pole1.value * impulse[i - 1] - step.pole2.value * impulse[i - 2];
    columns.col(2 * k + 1).tail(n - 1) = impulse.head(n - 1);
  }
  if (nuisance.offset) columns.rightCols(1).setOnes();
  return columns;
}

}  // namespace

std::vector<double> simulate(const Bvrm& model, std::span<const double> base_acceleration,
                             double sampling_rate_hz, Hold hold,
                             std::span<const ModalState> initial_states) {
  check_rate(sampling_rate_hz);
  if (!initial_states.empty() && initial_states.size() != model.modes.size())
    throw UserError("simulation: " + std::to_string(initial_states.size()) +
                    " initial states given for a model of " + std::to_string(model.modes.size()) +
                    " modes");
  ModalBank bank(model, sampling_rate_hz, hold);
  bank.reset(initial_states);
  std::vector<double> moment(base_acceleration.size());
  if (moment.empty()) return moment;
  const SampledDelay delay = sampled_delay(model.delay_s, sampling_rate_hz);
  const auto n_late = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, -delay.shift));
  ShapedInput shaped = shape_input(base_acceleration, hold, delay.fraction);
  for (std::vector<double>* signal : {&shaped.node, &shaped.midpoint, &shaped.direct})
    if (!signal->empty()) signal->insert(signal->end(), n_late, signal->back());
  std::vector<double> late(shaped.node.size());
  bank.process(shaped.node.data(), shaped.midpoint.empty() ? nullptr : shaped.midpoint.data(),
               shaped.direct.data(), late.data(), late.size());
  const auto last = static_cast<std::ptrdiff_t>(moment.size()) - 1;
  for (std::ptrdiff_t i = 0; i <= last; ++i)
    moment[static_cast<std::size_t>(i)] =
        late[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, i - delay.shift))];
  return moment;
}

std::vector<double> simulate_like(const Bvrm& model, std::span<const double> base_acceleration,
                                  std::span<const double> base_moment, double sampling_rate_hz,
                                  Hold hold, const Nuisance& nuisance) {
  if (base_moment.size() != base_acceleration.size())
    throw UserError("simulation: " + std::to_string(base_acceleration.size()) +
                    " samples of base acceleration, but " + std::to_string(base_moment.size()) +
                    " of base moment");
  std::vector<double> moment = simulate(model, base_acceleration, sampling_rate_hz, hold);
  const Eigen::MatrixXd columns =
      nuisance_columns(model, moment.size(), sampling_rate_hz, nuisance);
  if (columns.cols() == 0) return moment;
  const SampledDelay delay = sampled_delay(model.delay_s, sampling_rate_hz);
  const bool between = delay.fraction > 0. && hold != Hold::band_limited;
  const auto n = static_cast<Eigen::Index>(moment.size());
  const Eigen::Index unknown_start =
      std::clamp<Eigen::Index>(delay.shift + (between ? 1 : 0), 0, n);
  const Eigen::Index unknown_end = std::clamp<Eigen::Index>(-delay.shift, 0, n);
  const Eigen::Index n_used = n - unknown_start - unknown_end;
  if (n_used < 2 * columns.cols())
    throw UserError("simulation: a record of " + std::to_string(moment.size()) +
                    " samples is too short to estimate " + std::to_string(columns.cols()) +
                    " initial values");
  const Eigen::Map<const Eigen::VectorXd> measured(base_moment.data(), n);
  Eigen::Map<Eigen::VectorXd> simulated(moment.data(), n);
  const Eigen::MatrixXd used = columns.topRows(n_used);
  const Eigen::VectorXd error = (measured - simulated).segment(unknown_start, n_used);
  const Eigen::VectorXd value = used.colPivHouseholderQr().solve(error);
  simulated.tail(n - unknown_start) += columns.topRows(n - unknown_start) * value;
  return moment;
}

}  // namespace vibrissa::separation
