#include <algorithm>
#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

class Softening : public JointLaw {
 public:
  Softening(double depth, double level) : depth_(depth), level_(level) {}
  double moment(double y, double, double, double, bool commit) override {
    const double largest = std::max(largest_, std::abs(y));
    if (commit && largest > largest_) {
      largest_ = largest;
      factor_ = -depth_ * (1. - std::exp(-largest_ / level_));
    }
    return factor_ * y;
  }

 private:
  double depth_, level_, largest_ = 0., factor_ = 0.;
};

}  // namespace

Effect softening_history() {
  return Effect{
      .id = "softening_history",
      .link = Link::structure,
      .equation = "k = k0 (1 - D (1 - exp(-y_max / (L Y)))), y_max = largest so far",
      .source = "effects.md; Mullins (1969)",
      .confused_with = "hardening < 0; up/down ladder",
      .form_error = 0.1,
      .needs = {.base = true},
      .parameters = {log_uniform("softening", "1", 0.01, 0.6, 0.),
                     log_uniform("level", "1", 0.02, 3., 1.)},
      .starts = {{0.1, 0.3}, {0.1, 1.}, {0.1, 0.08}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
        chain.joint.push_back([depth = v[0], level = v[1] * scales.joint_moment_n_m](std::size_t) {
          return std::make_unique<Softening>(depth, level);
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
