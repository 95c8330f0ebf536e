#include <numbers>
#include <vector>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

/// Starting frequencies that are so close that no resonance of usual damping lies between two of
/// them.
std::vector<std::vector<double>> scanned_modes() {
  constexpr double damping_ratio = 0.02;
  std::vector<std::vector<double>> out;
  for (const double hz : geometric_series(46., 238., 1. + 2. * damping_ratio))
    out.push_back({hz, damping_ratio, 0.005});
  return out;
}

}  // namespace

Effect extra_mode() {
  constexpr double lowest_hz = 45.;
  Parameter frequency = log_uniform("frequency", "Hz", lowest_hz, 240., 100.);
  // Beyond the motion it is no more than the residual of modes that the simulation lacks.
  frequency.in_moved_band = true;
  return Effect{.id = "extra_mode",
                .about = "one more resonance",
                .link = Link::structure,
                .source = "Ewins 2000, ch. 2: response as a sum of modes",
                .model_form_error = 0.03,
                .needs = {.base = true, .moved_s = 3., .moved_hz = lowest_hz},
                .parameters = {frequency,
                               relative("of critical damping",
                                        log_uniform("damping_ratio", "1", 0.004, 0.15, 0.02)),
                               relative("times |M / a| at 0 Hz (M / a itself is negative)",
                                        uniform("residue", "1", -0.15, 0.15, 0.))},
                .starts = {{60., 0.02, 0.005},
                           {60., 0.02, -0.005},
                           {80., 0.02, 0.005},
                           {80., 0.02, -0.005},
                           {105., 0.02, 0.005},
                           {105., 0.02, -0.005},
                           {140., 0.02, 0.005},
                           {140., 0.02, -0.005},
                           {185., 0.02, 0.005},
                           {185., 0.02, -0.005}},
                .scanned = scanned_modes(),
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  const double w = 2. * std::numbers::pi * v[0];
                  chain.parallel.push_back([w, z = v[1], g = v[2] * scales.static_gain](Complex s) {
                    const Complex x = s / w;
                    return g / (x * x + 2. * z * x + 1.);
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
