#include <cmath>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

/// Changes the moduli of silicone and wire by the sensitivities of the finite-element model; each
/// is a spring in series with the rest of the first mode.
void change_materials(Chain& chain, const ParameterPath& wire, const ParameterPath& silicone,
                      const std::span<const double> v) {
  const double of_wire = std::pow(v[0], v[2]), of_silicone = v[0] / of_wire,
               wire_ratio = spring_ratio(of_wire, NominalModel::compliance_share(wire)),
               silicone_ratio = spring_ratio(of_silicone, NominalModel::compliance_share(silicone));
  std::vector<double> before;
  for (const StructuralMode& mode : chain.structure.modes) before.push_back(mode.frequency_rad_s);
  chain.structure.follow(silicone, std::log(silicone_ratio));
  chain.structure.follow(wire, std::log(wire_ratio));
  chain.structure.modes.front().frequency_rad_s = before.front() * std::sqrt(v[0]);
  for (std::size_t k = 0; k < before.size(); ++k) {
    StructuralMode& mode = chain.structure.modes[k];
    mode.scale_damping(std::pow(mode.frequency_rad_s / before[k], 2. * v[1] - 1.));
  }
  chain.joint_stiffness *= silicone_ratio;
  chain.joint_share /= chain.joint_share + (1. - chain.joint_share) * silicone_ratio;
}

/// What a part that is softer than the rest does to one mode more: usually a few percent, heavy
/// tails. mode 3 stands for those above it, too.
Parameter of_mode(const std::string& name, const std::size_t mode) {
  Parameter out = ratio_near_one(name + std::to_string(mode), 0.05, 0.4, 2.5);
  out.prior.kind = Prior::Kind::student;
  out.prior.degrees_of_freedom = 1.;
  out.relative_to.clear();
  out.mode = mode;
  return out;
}

/// k = ratio k0, c = ratio^q c0 of one mode: zeta = c / (2 sqrt(k m)).
void stiffen(StructuralMode& mode, const double ratio, const double q) {
  mode.frequency_rad_s *= std::sqrt(ratio);
  mode.scale_damping(std::pow(ratio, q - 0.5));
}

}  // namespace

Effect stiffness() {
  return Effect{
      .id = "stiffness",
      .about = "the elastic parts are stiffer or softer",
      .link = Link::structure,
      .source = "Friswell and Mottershead 1995, sensitivity methods; Gent 1958, modulus of rubber",
      .calibration = true,
      .model_form_error = 0.01,
      .parameters = {ratio_near_one("ratio", 0.03, 0.3, 1.6),
                     normal("damping_exponent", "1", 0., 0.5, -0.8, 1.2, 0.),
                     normal("modal_share", "1", 0.5, 0.5, 0., 1., 0.5),
                     of_mode("ratio_of_mode_", 2), of_mode("ratio_of_mode_", 3),
                     of_mode("gain_of_mode_", 2), of_mode("gain_of_mode_", 3)},
      .starts = {{0.97, 0., 0.5, 1., 1., 1., 1.}, {1.03, 0., 0.5, 1., 1., 1., 1.}},
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
        stiffen(mode, modal, v[1]);
        for (std::size_t i = 1; i < chain.structure.modes.size(); ++i) {
          StructuralMode& above = chain.structure.modes[i];
          stiffen(above, std::sqrt(v[0]) * (i == 1 ? v[3] : v[4]), v[1]);
          const double gain = above.base_gain * (i == 1 ? v[5] : v[6]);
          mode.base_gain -= gain - above.base_gain;
          above.base_gain = gain;
        }
      }};
}

}  // namespace vibrissa::diagnosis::effects
