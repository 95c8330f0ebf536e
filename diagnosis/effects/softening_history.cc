#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

class Softening : public JointLaw {
 public:
  Softening(double depth, double level) : depth_(depth), level_(level) {}
  Lanes moment(const Lanes& y, const Lanes&, const Lanes&, double, bool commit) override {
    const Lanes size = y.abs();
    if (commit && (size > largest_).any()) {
      largest_ = largest_.max(size);
      factor_ = -depth_ * (1. - (-largest_ / level_).exp());
    }
    return factor_ * y;
  }

 private:
  double depth_, level_;
  Lanes largest_ = Lanes::Zero(), factor_ = Lanes::Zero();
};

}  // namespace

Effect softening_history() {
  return Effect{
      .id = "softening_history",
      .about = "the silicone softens once it has been strained",
      .link = Link::structure,
      .source = "Mullins 1969; Ogden and Roxburgh 1999, strain energy",
      .model_form_error = 0.1,
      .needs = {.base = true},
      .parameters = {relative("of the stiffness", log_uniform("softening", "1", 3e-4, 0.6, 0.)),
                     relative("of the peak moment", log_uniform("level", "1", 0.02, 3., 1.))},
      .starts = {{0.1, 0.3}, {0.1, 1.}, {0.1, 0.08}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
        chain.joint.push_back([depth = v[0], level = v[1] * scales.joint_moment_n_m](const Lanes&) {
          return std::make_unique<Softening>(depth, level);
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
