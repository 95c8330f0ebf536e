#include "separation/nonlinear/nonlinear_bank.h"

#include <cmath>

#include "separation/nonlinear/nonlinear_separator.h"
#include "signals/record/record.h"

namespace vibrissa::separation {

namespace {

const NonlinearBvrm& checked(const NonlinearBvrm& model) {
  check(model);
  return model;
}

}  // namespace

NonlinearBank::NonlinearBank(const NonlinearBvrm& model, double sampling_rate_hz, Hold hold)
    : delay_(sampled_delay(checked(model).linear.delay_s, sampling_rate_hz)),
      path_(hold, hold == Hold::band_limited ? 0. : delay_.fraction),
      has_midpoints_(hold == Hold::band_limited),
      direct_term_(model.linear.direct_term_kg_m) {
  for (std::size_t k = 0; k < model.linear.modes.size(); ++k) {
    const ModalTerm& term = model.linear.modes[k];
    if (k == model.mode)
      modes_.push_back({ModeIntegrator(term, model.law, sampling_rate_hz, path_, false), term.b1,
                        term.b0, model.law_gain_kg_m(),
                        diverged_in_largest_deflections * model.largest_deflection_m});
    else
      modes_.push_back(
          {ModeIntegrator(term, {}, sampling_rate_hz, path_, false), term.b1, term.b0});
  }
}

void NonlinearBank::process(const double* node, const double* midpoint, const double* direct,
                            double* output, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    output[i] = next(node[i], has_midpoints_ ? midpoint[i] : 0., direct[i]);
}

double NonlinearBank::next(double node, double midpoint, double direct) {
  if (!started_) {
    for (Mode& mode : modes_) mode.integrator.start(0., 0.);
    knots_.fill(node);
    last_midpoint_ = midpoint;
    started_ = true;
    return direct_term_ * direct;
  }
  const double last = knots_[2];
  knots_ = {has_midpoints_ ? last : knots_[1], has_midpoints_ ? last_midpoint_ : last, node};
  last_midpoint_ = midpoint;
  double moment = direct_term_ * (has_midpoints_ ? direct : weighted(path_.direct, knots_));
  for (Mode& mode : modes_) {
    mode.integrator.advance(knots_);
    restart_when_diverged(mode);
    moment += mode.b0 * mode.integrator.position_m() + mode.b1 * mode.integrator.velocity_m_s();
    if (mode.law_gain != 0.) moment += mode.law_gain * mode.integrator.law_force();
  }
  return moment;
}

void NonlinearBank::restart_when_diverged(Mode& mode) {
  const ModeIntegrator& state = mode.integrator;
  if (!(std::abs(state.position_m()) < mode.largest_m && std::isfinite(state.velocity_m_s())))
    mode.integrator.start(0., 0.);
}

std::vector<double> simulate(const NonlinearBvrm& model, std::span<const double> base_acceleration,
                             double sampling_rate_hz, Hold hold) {
  NonlinearSeparator separator(model, sampling_rate_hz, hold);
  signals::Record record(sampling_rate_hz, base_acceleration.size());
  record.set_channel(signals::channel::base_acceleration,
                     {base_acceleration.begin(), base_acceleration.end()});
  record.set_channel(signals::channel::base_moment,
                     std::vector<double>(base_acceleration.size(), 0.));
  std::vector<double> moment = separate_record(separator, record);
  for (double& value : moment) value = -value;
  return moment;
}

}  // namespace vibrissa::separation
