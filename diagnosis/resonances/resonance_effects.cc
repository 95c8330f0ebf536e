#include "diagnosis/resonances/resonance_effects.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace vibrissa::diagnosis {
namespace {

constexpr double share_beyond = 0.1;
constexpr double gent_modulus_pa = 0.73e6, yeoh_modulus_pa = 2.04e6;

double density_within(const Prior& prior, const double x) {
  return x < prior.low || x > prior.high ? 0. : std::exp(prior.log_density(x));
}

/// k / k0 without and with the spring below.
struct Stiffness {
  double own, total;
};
Stiffness stiffness(const ModeChange& change, const double joint_share) {
  const double compliance = joint_share / change.joint + 1. - joint_share;
  return {1. / compliance, 1. / (compliance + change.series_compliance)};
}

/// Squared frequency ratio that the mode must have without its mount so that it has x on the mount.
std::optional<double> without_mount(const ModeChange& change, const double x) {
  if (!change.mount_frequency) return x;
  const double b2 = *change.mount_frequency * *change.mount_frequency;
  const double rest = b2 - x * (1. + change.mount_mass);
  if (rest <= 0.) return std::nullopt;
  return x * (b2 - x) / rest;
}

const Parameter& catalogue_parameter(const Effect& effect, const std::string& name) {
  const auto found = std::ranges::find(effect.parameters, name, &Parameter::name);
  assert(found != effect.parameters.end());
  return *found;
}

/// A parameter of the catalogue with a prior that is uniform over its usual range.
void set_usual(ResonanceEffect& out, const std::string& parameter) {
  out.parameter = catalogue_parameter(*out.effect, parameter);
  out.prior = {.usual = {.kind = Prior::Kind::uniform,
                         .low = out.parameter.coordinate(out.usual_low),
                         .high = out.parameter.coordinate(out.usual_high)},
               .beyond = out.parameter.prior};
}

/// Usual range of the silicone's modulus ratio, by two ways to know the modulus.
std::array<double, 2> usual_modulus_ratio(const std::optional<double> modulus_pa) {
  constexpr double rounding = 1.01;
  if (modulus_pa && *modulus_pa * rounding >= gent_modulus_pa &&
      *modulus_pa <= yeoh_modulus_pa * rounding)
    return {gent_modulus_pa / *modulus_pa, yeoh_modulus_pa / *modulus_pa};
  const double spread = yeoh_modulus_pa / gent_modulus_pa;
  return {1. / spread, spread};
}

}  // namespace

double squared_frequency_ratio(const ModeChange& change, const double joint_share) {
  const double own = stiffness(change, joint_share).total / change.inertia;
  if (!change.mount_frequency) return own;
  const double b2 = *change.mount_frequency * *change.mount_frequency;
  const double sum = b2 + own * (1. + change.mount_mass);
  return 2. * own * b2 / (sum + std::sqrt(sum * sum - 4. * own * b2));
}

double damping_ratio_factor(const ModeChange& change, const double joint_share,
                            const double nominal_damping_ratio) {
  const auto [own, total] = stiffness(change, joint_share);
  const double alone = total / change.inertia;
  const double factor = std::sqrt(alone) * total / (own * own);
  if (!change.mount_frequency || change.mount_mass == 0.) return factor;
  const double squared = squared_frequency_ratio(change, joint_share);
  const double x = squared / alone, gap = 1. - x;
  if (gap <= 0.) return factor;
  // Share of the strain energy in the mount: d ln(squared) / d ln(b^2).
  const double part = 1. + change.mount_mass / gap;
  const double in_mount = part / (part + x * change.mount_mass / (gap * gap));
  return (1. - in_mount) * factor * std::sqrt(x) + in_mount * mount_damping_ratio /
                                                       nominal_damping_ratio * std::sqrt(squared) /
                                                       *change.mount_frequency;
}

double UsualPrior::density(const double x) const {
  if (!beyond) return density_within(usual, x);
  return (1. - share_beyond) * density_within(usual, x) + share_beyond * density_within(*beyond, x);
}

void ResonanceEffect::apply(const double value, ModeChange& change) const {
  const double factor = map.to_factor(value);
  switch (part) {
    case Part::joint:
      change.joint *= factor;
      break;
    case Part::inertia:
      change.inertia *= factor;
      break;
    case Part::series:
      change.series_compliance += factor;
      break;
    case Part::mount:
      change.mount_frequency = factor;
      break;
  }
}

std::optional<double> ResonanceEffect::solve(const ModeChange& others, const double squared_ratio,
                                             const double joint_share) const {
  const Stiffness k = stiffness(others, joint_share);
  if (part == Part::mount) {
    const double alone = k.total / others.inertia;
    if (alone <= squared_ratio) return std::nullopt;
    const double b2 = squared_ratio * (1. + others.mount_mass * alone / (alone - squared_ratio));
    return map.to_value(std::sqrt(b2));
  }
  const std::optional<double> alone = without_mount(others, squared_ratio);
  if (!alone) return std::nullopt;
  if (part == Part::inertia) return map.to_value(k.total / *alone / others.inertia);
  const double compliance = 1. / (*alone * others.inertia);
  const double rest =
      compliance - (part == Part::joint ? 1. - joint_share + others.series_compliance
                                        : 1. / k.own + others.series_compliance);
  if (rest <= 0.) return std::nullopt;
  return map.to_value(part == Part::joint ? joint_share / rest / others.joint : rest);
}

std::vector<ResonanceEffect> resonance_effects(const double simulated_hz,
                                               const std::optional<double> silicone_modulus_pa) {
  using Part = ResonanceEffect::Part;
  using Map = ResonanceEffect::Map;
  const Map same{[](double x) { return x; }, [](double x) { return x; }},
      inverse{[](double x) { return 1. / x; }, [](double x) { return 1. / x; }},
      added{[](double x) { return 1. + x; }, [](double factor) { return factor - 1.; }},
      taken{[](double x) { return 1. - x; }, [](double factor) { return 1. - factor; }},
      // By the describing function of a cubic spring at the peak amplitude.
      cubic{[](double x) { return 1. + 0.75 * x; }, [](double f) { return (f - 1.) / 0.75; }},
      frequency{[=](double hz) { return hz / simulated_hz; },
                [=](double ratio) { return ratio * simulated_hz; }};
  std::vector<ResonanceEffect> out;
  const auto add = [&](const char* id, Part part, const Map& map, double low, double high,
                       const char* remark) -> ResonanceEffect& {
    out.push_back({.effect = &find_effect(id),
                   .part = part,
                   .map = map,
                   .usual_low = low,
                   .usual_high = high,
                   .remark = remark});
    return out.back();
  };
  const auto set_own = [](ResonanceEffect& effect, const Parameter& parameter) {
    effect.parameter = parameter;
    effect.prior.usual = parameter.prior;
  };
  const auto [low, high] = usual_modulus_ratio(silicone_modulus_pa);
  set_own(add("stiffness", Part::joint, same, low, high, "the silicone has another modulus"),
          log_usual("silicone_modulus_ratio", "1", low, high, 1e-3, 1e3, 1.));
  set_own(add("mass", Part::inertia, same, 0.7, 1.4, "possible origins: infill, glue, magnet"),
          log_usual("ratio", "1", 0.9, 1.1, 0.3, 3., 1.));
  set_usual(add("base_compliance", Part::series, inverse, 1., 20.,
                "stiffness k_s / k0 of a spring below the silicone"),
            "stiffness_ratio");
  ResonanceEffect& mount = add("mount_compliance", Part::mount, frequency, 60., 200.,
                               "a second resonance would appear nearby");
  set_usual(mount, "frequency");
  mount.mass_ratio = catalogue_parameter(*mount.effect, "mass_ratio");
  set_own(add("temperature_drift", Part::joint, added, -0.3, 0.3,
              "a shift of 0.1 needs 20 K at 0.5 %/K"),
          {.name = "shift",
           .unit = "1",
           .prior = {.kind = Prior::Kind::student, .scale = 0.1, .low = -0.4, .high = 0.4}});
  set_usual(add("softening_history", Part::joint, taken, 0.02, 0.4,
                "softening of the silicone at the test level"),
            "softening");
  set_usual(add("hardening", Part::joint, cubic, -0.3, 0.5,
                "k3 A^2 / k at the peak amplitude of the test"),
            "cubic_ratio");
  // Elements parallel to the joint's spring add at most their own stiffness.
  const char* const can_only_raise = "it can only raise the resonance";
  set_usual(add("viscoelastic", Part::joint, added, 0.02, 1., can_only_raise), "strength");
  set_usual(add("joint_friction", Part::joint, added, 0.1, 0.8, can_only_raise), "stiffness_ratio");
  return out;
}

}  // namespace vibrissa::diagnosis
