#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

class DeadZone : public JointLaw {
 public:
  DeadZone(double gap, double loss) : gap_(gap), loss_(loss) {}
  Lanes moment(const Lanes& y, const Lanes&, const Lanes&, double, bool) override {
    return -loss_ * y.max(-gap_).min(gap_);
  }

 private:
  double gap_, loss_;
};

}  // namespace

Effect backlash() {
  return Effect{
      .id = "backlash",
      .about = "play in a joint",
      .link = Link::structure,
      .source = "Worden and Tomlinson 2001, sec. 2.3.3; Kahraman and Singh 1990, dead zone",
      .model_form_error = 0.1,
      .needs = {.base = true},
      .parameters = {relative("of the peak moment, half of the play",
                              log_uniform("gap", "1", 5e-4, 0.6, 0.)),
                     relative("of the stiffness, missing within the play",
                              uniform("loss", "1", 0.1, 1., 0.))},
      .starts = {{0.02, 0.6}, {0.1, 0.6}, {0.005, 0.6}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
        chain.joint.push_back([gap = v[0] * scales.joint_moment_n_m, loss = v[1]](const Lanes&) {
          return std::make_unique<DeadZone>(gap, loss);
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
