#include "separation/model/simulation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "separation/model/input_shaper.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

void check_rate(double sampling_rate_hz) {
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError("simulation: the sampling rate " + signals::to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
}

// Results that come too early by the whole-sample delay. Before the record they are as at its
// start.
void delay(std::vector<double>& moment, std::size_t n_samples) {
  const std::size_t n = std::min(n_samples, moment.size());
  const double first = moment[0];
  std::shift_right(moment.begin(), moment.end(), static_cast<std::ptrdiff_t>(n));
  std::fill_n(moment.begin(), n, first);
}

// Results that come too late: what follows the record is as it ended.
void advance(ModalBank& bank, const ShapedInput& last, std::vector<double>& moment,
             std::size_t n_samples) {
  const std::vector<double> node(n_samples, last.node[0]), direct(n_samples, last.direct[0]);
  const std::vector<double> midpoint(n_samples, last.midpoint.empty() ? 0. : last.midpoint[0]);
  std::vector<double> later(n_samples);
  bank.process(node.data(), last.midpoint.empty() ? nullptr : midpoint.data(), direct.data(),
               later.data(), n_samples);
  moment.insert(moment.end(), later.begin(), later.end());
  moment.erase(moment.begin(), moment.begin() + static_cast<std::ptrdiff_t>(n_samples));
}

void run(ModalBank& bank, std::span<const double> input, Hold hold, double fraction,
         std::vector<double>& moment) {
  const std::size_t n = moment.size();
  ShapedInput last{.node = {input.back()}, .midpoint = {}, .direct = {input.back()}};
  if (hold == Hold::band_limited) {
    const ShapedInput shaped = shape_input(input, hold, fraction);
    bank.process(shaped.node.data(), shaped.midpoint.data(), shaped.direct.data(), moment.data(),
                 n);
    last = {{shaped.node.back()}, {shaped.midpoint.back()}, {shaped.direct.back()}};
  } else {
    bank.process(input.data(), nullptr, input.data(), moment.data(), n);
  }
  if (bank.shift() > 0) delay(moment, static_cast<std::size_t>(bank.shift()));
  if (bank.shift() < 0) advance(bank, last, moment, static_cast<std::size_t>(-bank.shift()));
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
  run(bank, base_acceleration, hold, sampled_delay(model.delay_s, sampling_rate_hz).fraction,
      moment);
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
