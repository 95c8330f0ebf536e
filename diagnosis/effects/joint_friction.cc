#include <array>
#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

class Iwan : public JointLaw {
 public:
  Iwan(double stiffness, double slip, double spread) : stiffness_(stiffness / n) {
    for (std::size_t i = 0; i < n; ++i)
      slip_[i] = slip / n * (1. + spread * (0.5 * static_cast<double>(i) - 0.75));
    moment_.fill(Lanes::Zero());
  }
  Lanes moment(const Lanes& y, const Lanes&, const Lanes&, double, bool commit) override {
    Lanes sum = Lanes::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      const Lanes next = (moment_[i] + stiffness_ * (y - y_)).max(-slip_[i]).min(slip_[i]);
      sum += next;
      if (commit) moment_[i] = next;
    }
    if (commit) y_ = y;
    return sum;
  }

 private:
  static constexpr std::size_t n = 4;
  double stiffness_;
  std::array<double, n> slip_{};
  Lanes y_ = Lanes::Zero();
  std::array<Lanes, n> moment_;
};

}  // namespace

Effect joint_friction() {
  return Effect{
      .id = "joint_friction",
      .about = "dry friction in a joint",
      .link = Link::structure,
      .source = "Iwan 1966, distributed-element model for hysteresis",
      .model_form_error = 0.15,
      .needs = {.base = true},
      .parameters = {relative("of the stiffness",
                              log_uniform("stiffness_ratio", "1", 0.03, 1.5, 0.)),
                     relative("of the peak moment", log_uniform("slip_moment", "1", 2e-4, 0.7, 1.)),
                     relative("of the slip moment", uniform("spread", "1", 0., 1.2, 0.))},
      .starts = {{0.3, 0.02, 0.5}, {0.3, 0.07, 0.5}, {0.3, 0.2, 0.5}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
        chain.joint.push_back([r = v[0], slip = v[1] * scales.joint_moment_n_m, d = v[2]](
                                  const Lanes&) { return std::make_unique<Iwan>(r, slip, d); });
      }};
}

}  // namespace vibrissa::diagnosis::effects
