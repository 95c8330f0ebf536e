#include <array>

#include "diagnosis/model/effect.h"
#include "diagnosis/model/joint_model.h"

namespace vibrissa::diagnosis::effects {
namespace {

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

}  // namespace

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

}  // namespace vibrissa::diagnosis::effects
