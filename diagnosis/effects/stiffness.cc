#include <algorithm>

#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

/// Spring of a joint that makes the mode's stiffness so many times what it was; a joint with a
/// small share in the compliance cannot stiffen it at will.
double spring_ratio(const double mode_ratio, const double joint_share) {
  constexpr double least_compliance = 1e-3;
  return joint_share / std::max(least_compliance, 1. / mode_ratio - 1. + joint_share);
}

/// Exponents per logarithm of the first mode's stiffness: wire and silicone in these shares.
ParameterPath mixed_path(const ParameterPath& wire, const ParameterPath& silicone,
                         const double wire_share) {
  const double of_wire = 0.5 * wire_share / wire.frequency.front(),
               of_silicone = 0.5 * (1. - wire_share) / silicone.frequency.front();
  const auto mix = [&](const std::vector<double>& w, const std::vector<double>& s) {
    std::vector<double> out(w.size());
    for (std::size_t k = 0; k < w.size(); ++k) out[k] = of_wire * w[k] + of_silicone * s[k];
    return out;
  };
  return {.frequency = mix(wire.frequency, silicone.frequency),
          .base_gain = mix(wire.base_gain, silicone.base_gain),
          .wind_gain = mix(wire.wind_gain, silicone.wind_gain)};
}

/// By what the finite-element model says of silicone and wire.
void change_materials(Chain& chain, const ParameterPath& wire, const ParameterPath& silicone,
                      const std::span<const double> v) {
  const double log_ratio = std::log(v[0]);
  const ParameterPath path = mixed_path(wire, silicone, v[2]);
  chain.structure.follow(path, log_ratio);
  for (std::size_t k = 0; k < chain.structure.modes.size(); ++k) {
    StructuralMode& mode = chain.structure.modes[k];
    const double damping = std::exp((v[1] - 0.5) * 2. * path.frequency[k] * log_ratio);
    mode.damping_ratio *= damping;
    mode.base_rate *= damping;
    mode.wind_rate *= damping;
  }
  const double joint = std::exp(0.5 * (1. - v[2]) / silicone.frequency.front() * log_ratio);
  chain.joint_stiffness *= joint;
  chain.joint_share /= chain.joint_share + (1. - chain.joint_share) * joint;
}

}  // namespace

Effect stiffness() {
  return Effect{
      .id = "stiffness",
      .link = Link::structure,
      .equation =
          "k = r k0 of the first mode: r^s by itself, r^(1 - s) by its joint's spring K, "
          "p / (K / K0) + 1 - p = r^(s - 1); with a finite-element model r^s by its wire and "
          "r^(1 - s) by its silicone, in all modes; dampers c = (k / k0)^q c0",
      .source = "effects.md; q: a loss factor keeps to 1, a damper to 0, modal damping to 1/2",
      .confused_with = "mass (gain), base_compliance; added known mass, static pull",
      .retune = true,
      .form_error = 0.01,
      .parameters = {ratio_near_one("ratio", 0.03, 0.3, 1.6),
                     normal("damping_exponent", "1", 0., 0.5, -0.8, 1.2, 0.),
                     normal("modal_share", "1", 0.5, 0.5, 0., 1., 0.5)},
      .starts = {{0.97, 0., 0.5}, {1.03, 0., 0.5}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        if (chain.structure.modes.empty()) return;
        const ParameterPath *wire = chain.structure.path("wire_modulus"),
                            *silicone = chain.structure.path("silicone_modulus");
        if (wire && silicone) return change_materials(chain, *wire, *silicone, v);
        StructuralMode& mode = chain.structure.modes.front();
        const double modal = std::pow(v[0], v[2]);
        const double joint = spring_ratio(v[0] / modal, chain.joint_share);
        chain.joint_change.spring *= joint;
        chain.joint_change.damper *= std::pow(joint, v[1]);
        mode.frequency_rad_s *= std::sqrt(modal);
        // zeta = c / (2 sqrt(k m)); so is the viscous moment over the elastic one.
        const double damping = std::pow(modal, v[1] - 0.5);
        mode.damping_ratio *= damping;
        mode.base_rate *= damping;
        mode.wind_rate *= damping;
      }};
}

}  // namespace vibrissa::diagnosis::effects
