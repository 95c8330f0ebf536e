#include "diagnosis/nominal_model.h"

namespace vibrissa::diagnosis {
namespace {

Complex second_order(const StructuralMode& mode, Complex s, double gain, double rate) {
  const Complex x = s / mode.frequency_rad_s;
  return (gain + rate * x) / (x * x + 2. * mode.damping_ratio * x + 1.);
}

}  // namespace

Complex StructuralMode::base_response(const Complex s) const {
  return second_order(*this, s, base_gain, base_rate);
}

Complex StructuralMode::wind_response(const Complex s) const {
  return second_order(*this, s, wind_gain, wind_rate);
}

Complex NominalModel::base_response(const Complex s) const {
  Complex sum = base_direct;
  for (const StructuralMode& mode : modes) sum += mode.base_response(s);
  return sum;
}

Complex NominalModel::wind_response(const Complex s) const {
  Complex sum = wind_direct;
  for (const StructuralMode& mode : modes) sum += mode.wind_response(s);
  return sum;
}

}  // namespace vibrissa::diagnosis
