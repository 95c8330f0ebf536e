#include "diagnosis/model/effect.h"
#include "diagnosis/model/joint_model.h"

namespace vibrissa::diagnosis::effects {
namespace {

class Drift : public JointLaw {
 public:
  Drift(const Lanes& slope, const Lanes& offset, double loss_s)
      : slope_(slope), offset_(offset), loss_s_(loss_s) {}
  Lanes moment(const Lanes& y, const Lanes& y_rate, const Lanes& t_s, double, bool) override {
    return (offset_ + slope_ * t_s) * (y + loss_s_ * y_rate);
  }

 private:
  Lanes slope_, offset_;
  double loss_s_;
};

}  // namespace

Effect temperature_drift() {
  return Effect{
      .id = "temperature_drift",
      .about = "the stiffness drifts in time",
      .link = Link::structure,
      .source = "Ferry 1980, ch. 11; Treloar 1975, ch. 4: modulus of rubber and temperature",
      .model_form_error = 0.05,
      // Silicone warms over minutes. An apparent drift within a few seconds is accelerometer noise
      // that the mode amplifies.
      .needs = {.base = true, .moved_s = 3.},
      .parameters = {relative("of the stiffness, from the first to the last sample of a record",
                              uniform("within_record", "1", -0.4, 0.4, 0.)),
                     relative("of the stiffness, from one record to the next",
                              normal("between_records", "1", 0., 0.005, -0.1, 0.1, 0.)),
                     relative("as exponent of the stiffness",
                              normal("damping_exponent", "1", 0., 0.5, -0.8, 1.2, 0.)),
                     log_uniform("settled_after", "records", 1., 100., 100.)},
      .starts = {{0.02, 0., 0., 30.}, {-0.02, 0., 0., 30.}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
        const std::optional<JointModel> joint = joint_of(chain);
        if (!joint) return;
        const double loss_s = v[2] * joint->loss / joint->frequency_rad_s;
        chain.joint.push_back(
            [slope = v[0] / scales.duration_s, jump = v[1], loss_s, n = v[3]](const Lanes& number) {
              const Lanes to_go = (-number / n).exp();
              return std::make_unique<Drift>(slope * to_go, jump * n * (1. - to_go), loss_s);
            });
      }};
}

}  // namespace vibrissa::diagnosis::effects
