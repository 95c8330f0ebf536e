#include "diagnosis/resonances/resonance_model.h"

#include <cmath>
#include <numbers>

#include "diagnosis/model/words.h"
#include "diagnosis/nominal/nominal_from_model.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {

ResonanceModel resonance_model_from(const signals::ReducedModel& model, const double simulated_hz) {
  constexpr double same_sensor = 0.1;
  const NominalModel nominal = nominal_from(model);
  const double hz = nominal.modes.front().frequency_rad_s / (2. * std::numbers::pi);
  if (!(std::abs(hz / simulated_hz - 1.) <= same_sensor))
    throw signals::UserError("model '" + model.name + "' has its first resonance at " +
                             three_digits(hz) + " Hz, but the simulated resonance is given as " +
                             three_digits(simulated_hz) + " Hz: give the model that belongs to it");
  ResonanceModel out{.joint_share = nominal.joint_share,
                     .joint_share_deviation = nominal.joint_share_deviation,
                     .silicone_modulus_pa = std::nullopt};
  for (const signals::Sensitivity& sensitivity : model.sensitivities)
    if (sensitivity.parameter == "silicone_modulus" && sensitivity.nominal_value > 0.)
      out.silicone_modulus_pa = sensitivity.nominal_value;
  return out;
}

}  // namespace vibrissa::diagnosis
