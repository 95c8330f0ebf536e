#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "diagnosis/model/effect.h"
#include "diagnosis/model/joint_model.h"

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

/// Enough branches for a smooth relaxation spectrum over the widest spread.
constexpr std::size_t n_branches = 5;

std::array<double, n_branches> branch_times(double tau, double decades) {
  std::array<double, n_branches> times{};
  for (std::size_t i = 0; i < n_branches; ++i) {
    const double index = static_cast<double>(i) / (n_branches - 1) - 0.5;
    times[i] = tau * std::pow(10., decades * index);
  }
  return times;
}

constexpr double damping_ratio = 0.02;  // of starting values of extra_mode

std::vector<std::vector<double>> modes_at(const std::vector<double>& frequencies_hz,
                                          const std::vector<double>& residues) {
  std::vector<std::vector<double>> out;
  for (const double hz : frequencies_hz)
    for (const double residue : residues) out.push_back({hz, damping_ratio, residue});
  return out;
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

Effect damping() {
  return Effect{.id = "damping",
                .about = "more or less damping",
                .link = Link::structure,
                .source = "Ungar and Kerwin 1962, loss factors by strain energy; Ewins 2000, ch. 2",
                .calibration = true,
                .model_form_error = 0.02,
                .parameters = {ratio_near_one("ratio", 0.1, 0.2, 4.),
                               normal("rest_exponent", "1", 0.5, 0.5, 0., 1., 0.5),
                               normal("modal_share", "1", 0.5, 0.5, 0., 1., 0.5),
                               spread_over_modes(2), spread_over_modes(3)},
                .starts = {{0.9, 0.5, 0.5, 0.5, 0.5}, {1.1, 0.5, 0.5, 0.5, 0.5}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  const std::optional<JointModel> joint = joint_of(chain);
                  if (!joint) return;
                  const bool joint_damps_most = 0.5 * joint->share * joint->loss >= joint->damping;
                  const double modal = std::pow(v[0], v[2]);
                  const double most = v[0] / modal, least = std::pow(most, v[1]);
                  chain.joint_change.damper *= joint_damps_most ? most : least;
                  chain.joint_change.rest_damping *= joint_damps_most ? least : most;
                  for (std::size_t i = 0; i < chain.structure.modes.size(); ++i)
                    chain.structure.modes[i].scale_damping(
                        i == 0 ? modal : std::pow(v[0], i == 1 ? v[3] : v[4]));
                }};
}

Effect viscoelastic() {
  return Effect{
      .id = "viscoelastic",
      .about = "stiffness and loss of the silicone depend on frequency",
      .link = Link::structure,
      .source = "Ferry 1980, ch. 1 and 3: generalised Maxwell model, here with equal branches",
      .model_form_error = 0.08,
      .needs = {.base = true},
      // Half of its prior times are so slow that the effect equals a change of stiffness.
      .log_prior = -0.7,
      .parameters = {relative("of the static stiffness",
                              log_uniform("strength", "1", 2e-4, 1.5, 0.)),
                     log_uniform("tau", "s", 1e-3, 10., 0.01),
                     relative("decades of relaxation times", uniform("decades", "1", 0., 5., 0.))},
      .starts = {{0.1, 3e-3, 1.},
                 {0.1, 0.05, 1.},
                 {0.3, 1.5e-3, 1.},
                 {0.5, 3e-3, 1.},
                 {0.5, 3e-3, 2.5},
                 {0.3, 0.03, 4.}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        const std::optional<JointModel> joint = joint_of(chain);
        if (!joint) return;
        // The branches are parallel to spring and damper, which are unchanged.
        chain.relaxation.push_back([strength = v[0] / n_branches, times = branch_times(v[1], v[2]),
                                    joint = *joint](Complex s) {
          Complex sum = 0.;
          for (const double t : times) sum += s * t / (1. + s * t);
          return strength * sum / joint.stiffness_ratio(s);
        });
      }};
}

Effect extra_mode() {
  Parameter frequency = log_uniform("frequency", "Hz", 45., 240., 100.);
  // Beyond the motion it is no more than the residual of modes that the simulation lacks.
  frequency.in_moved_band = true;
  return Effect{.id = "extra_mode",
                .about = "one more resonance",
                .link = Link::structure,
                .source = "Ewins 2000, ch. 2: response as a sum of modes",
                .model_form_error = 0.03,
                .needs = {.base = true, .moved_s = 3.},
                .parameters = {frequency,
                               relative("of critical damping",
                                        log_uniform("damping_ratio", "1", 0.004, 0.15, 0.02)),
                               relative("times |M / a| at 0 Hz (M / a itself is negative)",
                                        uniform("residue", "1", -0.15, 0.15, 0.))},
                .starts = modes_at({60., 80., 105., 140., 185.}, {0.005, -0.005}),
                // So close that no resonance of usual damping lies between two of them.
                .scanned = modes_at(geometric_series(46., 238., 1. + 2. * damping_ratio), {0.005}),
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  const double w = 2. * std::numbers::pi * v[0];
                  chain.parallel.push_back([w, z = v[1], g = v[2] * scales.static_gain](Complex s) {
                    const Complex x = s / w;
                    return g / (x * x + 2. * z * x + 1.);
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
