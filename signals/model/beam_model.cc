#include "signals/model/beam_model.h"

#include <cmath>
#include <numbers>

#include "signals/base/error.h"

namespace vibrissa::signals {

double cantilever_root(const std::size_t n) {
  // Newton on cos x + 1/cosh x, which stays of order one for any n.
  double x = (static_cast<double>(n) - 0.5) * std::numbers::pi;
  for (int i = 0; i < 50; ++i) {
    const double inverse = 1. / std::cosh(x);
    const double change = (std::cos(x) + inverse) / (-std::sin(x) - std::tanh(x) * inverse);
    x -= change;
    if (std::abs(change) < 1e-15 * x) break;
  }
  return x;
}

double cantilever_sigma(const std::size_t n) {
  const double x = cantilever_root(n), inverse = 1. / std::cosh(x);
  return (std::tanh(x) - std::sin(x) * inverse) / (1. + std::cos(x) * inverse);
}

ReducedModel beam_model(const Beam& beam, const std::size_t n_modes) {
  for (const double value :
       {beam.length_m, beam.bending_stiffness_n_m2, beam.mass_per_length_kg_m}) {
    if (!(value > 0. && std::isfinite(value))) {
      throw UserError("beam: length, bending stiffness and mass per length must be positive");
    }
  }
  if (n_modes == 0) throw UserError("beam: ask for at least one mode");
  const double h = beam.length_m, mass = beam.mass_per_length_kg_m * h;
  ReducedModel model;
  model.name = "Euler-Bernoulli cantilever";
  for (std::size_t n = 1; n <= n_modes; ++n) {
    const double lambda = cantilever_root(n);
    const double omega = std::pow(lambda / h, 2) *
                         std::sqrt(beam.bending_stiffness_n_m2 / beam.mass_per_length_kg_m);
    ReducedMode mode;
    mode.frequency_hz = omega / (2. * std::numbers::pi);
    mode.damping_ratio = beam.damping_ratio;
    mode.participation = {2. * cantilever_sigma(n) * std::sqrt(mass) / lambda, 0., 0.};
    mode.moment_participation = {0., 2. * h * std::sqrt(mass) / (lambda * lambda), 0.};
    model.modes.push_back(mode);
  }
  model.rigid_moment[1][0] = 0.5 * mass * h;
  return model;
}

}  // namespace vibrissa::signals
