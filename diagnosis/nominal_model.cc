#include "diagnosis/nominal_model.h"

#include <cmath>

namespace vibrissa::diagnosis {
namespace {

Complex compliance(const StructuralMode& mode, Complex x) {
  return 1. / (x * x + 2. * mode.damping_ratio * x + 1.);
}

}  // namespace

Complex StructuralMode::base_response(const Complex s) const {
  const Complex x = s / frequency_rad_s;
  return (base_gain + base_rate * x) * compliance(*this, x);
}

Complex StructuralMode::wind_response(const Complex s) const {
  const Complex x = s / frequency_rad_s;
  return (wind_gain + wind_rate * x) * compliance(*this, x);
}

NominalModel::Responses NominalModel::responses(const Complex s) const {
  Responses sum{.base = base_direct, .wind = wind_direct};
  for (const StructuralMode& mode : modes) {
    const Complex x = s / mode.frequency_rad_s, c = compliance(mode, x);
    sum.base += (mode.base_gain + mode.base_rate * x) * c;
    sum.wind += (mode.wind_gain + mode.wind_rate * x) * c;
  }
  return sum;
}

double NominalModel::joint_viscous_ratio() const {
  if (modes.empty()) return 0.;
  const StructuralMode& mode = modes.front();
  if (readout == signals::Readout::rotation) return 2. * mode.damping_ratio;
  return mode.base_gain != 0. ? mode.base_rate / mode.base_gain : 0.;
}

std::size_t NominalModel::decay_samples(const double n_time_constants,
                                        const double sampling_rate_hz) const {
  if (modes.empty()) return 0;
  const StructuralMode& mode = modes.front();
  return static_cast<std::size_t>(
      std::ceil(n_time_constants * sampling_rate_hz / (mode.damping_ratio * mode.frequency_rad_s)));
}

}  // namespace vibrissa::diagnosis
