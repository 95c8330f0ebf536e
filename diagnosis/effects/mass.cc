#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {

Effect mass() {
  return Effect{
      .id = "mass",
      .link = Link::structure,
      .equation = "m = r m0, base forcing of the mode r^g",
      .source = "effects.md; g near 1, the whole mass is not all of the modal mass",
      .confused_with =
          "stiffness + damping + reference_gain (exact alias for one mode); added known mass",
      .retune = true,
      .form_error = 0.02,
      .needs = {.base = true},
      .parameters = {log_uniform("ratio", "1", 0.7, 1.45, 1.),
                     normal("forcing_exponent", "1", 1., 0.1, 0.6, 1.4, 1.)},
      .starts = {{0.95, 1.}, {1.05, 1.}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        StructuralMode& mode = chain.structure.modes.front();
        const double root = std::sqrt(v[0]);
        mode.frequency_rad_s /= root;
        mode.damping_ratio /= root;
        const double forcing = std::pow(v[0], v[1]);
        mode.base_gain *= forcing;
        mode.base_rate *= forcing / root;
        mode.wind_rate /= root;
      }};
}

}  // namespace vibrissa::diagnosis::effects
