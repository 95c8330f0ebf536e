#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

/// Multiplies the first mode's modal mass by a ratio; returns the factor on its base forcing.
double change_density(NominalModel& structure, const ParameterPath& path, const double ratio) {
  const double log_density = -0.5 * std::log(ratio) / path.frequency.front();
  structure.follow(path, log_density);
  return std::exp(path.base_gain.front() * log_density);
}

/// m = ratio m0 of one mode; its damper and spring stay.
void load(StructuralMode& mode, const double ratio) {
  const double slower = 1. / std::sqrt(ratio);
  mode.frequency_rad_s *= slower;
  mode.scale_damping(slower);
}

}  // namespace

Effect mass() {
  return Effect{
      .id = "mass",
      .about = "more or less moving mass",
      .link = Link::structure,
      .source = "Friswell and Mottershead 1995; Berman and Flannelly 1971, incomplete models",
      .calibration = true,
      .model_form_error = 0.02,
      .needs = {.base = true},
      .parameters = {relative("times the simulated value",
                              log_uniform("ratio", "1", 0.7, 1.45, 1.)),
                     normal("forcing_exponent", "1", 1., 0.1, 0.6, 1.4, 1.),
                     normal("direct", "1", 0., 0.005, -0.05, 0.05, 0.), spread_over_modes(2),
                     spread_over_modes(3)},
      .starts = {{0.95, 1., 0., 0.5, 0.5}, {1.05, 1., 0., 0.5, 0.5}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
        double forcing = std::pow(v[0], v[1]);
        if (const auto* density = chain.structure.path(chain.structure.mass_parameter()))
          forcing /= change_density(chain.structure, *density, v[0]);
        else
          for (std::size_t i = 0; i < chain.structure.modes.size(); ++i)
            load(chain.structure.modes[i], i == 0 ? v[0] : std::pow(v[0], i == 1 ? v[3] : v[4]));
        chain.mount.push_back([forcing](Complex) -> Complex { return forcing; });
        chain.parallel.push_back(
            [direct = v[2] * scales.static_gain](Complex) -> Complex { return direct; });
      }};
}

}  // namespace vibrissa::diagnosis::effects
