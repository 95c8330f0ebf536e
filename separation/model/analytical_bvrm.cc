#include "separation/model/analytical_bvrm.h"

#include <array>
#include <numbers>
#include <string>

#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

Bvrm reduced_bvrm(const signals::ReducedModel& model) {
  signals::check(model);
  const std::array<double, 3>&axial = model.axial_direction, about = model.moment_axis();
  double rest = 0.;
  for (std::size_t i = 0; i < 3; ++i) rest += about[i] * dot(model.rigid_moment[i], axial);
  Bvrm bvrm;
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    const signals::ReducedMode& mode = model.modes[k];
    if (!(mode.damping_ratio > 0.))
      throw signals::UserError("base vibration response model: mode " + std::to_string(k + 1) +
                               " of the reduced model is undamped; give it a damping ratio");
    const double static_moment =
        dot(mode.moment_participation, about) * dot(mode.participation, axial);
    const double omega = 2. * std::numbers::pi * mode.frequency_hz;
    bvrm.modes.push_back(make_modal_term(mode.frequency_hz, mode.damping_ratio, -static_moment,
                                         -2. * mode.damping_ratio * omega * static_moment));
    rest -= static_moment;
  }
  bvrm.direct_term_kg_m = -rest;
  return bvrm;
}

Bvrm beam_bvrm(const signals::Beam& beam, std::size_t n_modes) {
  return reduced_bvrm(signals::beam_model(beam, n_modes));
}

}  // namespace vibrissa::separation
