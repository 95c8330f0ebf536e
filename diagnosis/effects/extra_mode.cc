#include <numbers>
#include <vector>

#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

/// No resonance of usual damping lies between two of them.
std::vector<std::vector<double>> starts_of_extra_mode() {
  constexpr double damping_ratio = 0.02, residue = 0.005;
  std::vector<std::vector<double>> out;
  for (const double hz : geometric_series(48., 235., 1. + 2. * damping_ratio))
    for (const double sign : {1., -1.}) out.push_back({hz, damping_ratio, sign * residue});
  return out;
}

}  // namespace

Effect extra_mode() {
  return Effect{.id = "extra_mode",
                .link = Link::structure,
                .equation = "M += g M0 / ((s/w)^2 + 2 z s/w + 1) a",
                .source = "effects.md",
                .confused_with = "mount_compliance",
                .form_error = 0.03,
                .needs = {.base = true},
                .parameters = {log_uniform("frequency", "Hz", 45., 240., 100.),
                               log_uniform("damping_ratio", "1", 0.004, 0.15, 0.02),
                               uniform("residue", "1", -0.15, 0.15, 0.)},
                .starts = starts_of_extra_mode(),
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  const double w = 2. * std::numbers::pi * v[0];
                  chain.parallel.push_back([w, z = v[1], g = v[2] * scales.static_gain](Complex s) {
                    const Complex x = s / w;
                    return g / (x * x + 2. * z * x + 1.);
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
