#include "separation/nonlinear/nonlinear_bvrm.h"

#include <cmath>

#include "signals/base/error.h"

namespace vibrissa::separation {

using signals::UserError;

std::string to_string(LawReadout readout) {
  return readout == LawReadout::moment ? "moment" : "deflection";
}

LawReadout parse_law_readout(const std::string& name) {
  for (const LawReadout readout : {LawReadout::moment, LawReadout::deflection})
    if (to_string(readout) == name) return readout;
  throw UserError(signals::unknown_name("readout", name, {"moment", "deflection"}));
}

double NonlinearBvrm::law_gain_kg_m() const {
  return readout == LawReadout::moment ? linear.modes[mode].static_gain_kg_m() : 0.;
}

Hold NonlinearBvrm::hold_or(const std::optional<Hold>& told) const {
  return told.value_or(hold.value_or(Hold::first_order));
}

Bvrm at_small_amplitude(const NonlinearBvrm& model) {
  Bvrm out = model.linear;
  ModalTerm& mode = out.modes[model.mode];
  const double gain = model.law_gain_kg_m();
  for (const LawTerm& term : model.law) {
    const LawValue slope = law_function(term, 0., 0.);
    mode.a0 += term.coefficient * slope.by_deflection;
    mode.a1 += term.coefficient * slope.by_velocity;
    mode.b0 += gain * term.coefficient * slope.by_deflection;
    mode.b1 += gain * term.coefficient * slope.by_velocity;
  }
  return out;
}

void check(const NonlinearBvrm& model) {
  check(model.linear);
  check(model.law);
  if (model.mode >= model.linear.modes.size())
    throw UserError("nonlinear base vibration response model: its law is of mode " +
                    std::to_string(model.mode + 1) + ", but it has " +
                    std::to_string(model.linear.modes.size()) + " modes");
  for (const double largest : {model.largest_deflection_m, model.largest_speed_m_s})
    if (!(std::isfinite(largest) && largest > 0.))
      throw UserError(
          "nonlinear base vibration response model: largest_deflection_m and largest_speed_m_s "
          "must be positive and finite");
}

}  // namespace vibrissa::separation
