#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

class Drift : public JointLaw {
 public:
  Drift(double slope, const Lanes& offset) : slope_(slope), offset_(offset) {}
  Lanes moment(const Lanes& y, const Lanes&, const Lanes& t_s, double, bool) override {
    return (offset_ + slope_ * t_s) * y;
  }

 private:
  double slope_;
  Lanes offset_;
};

}  // namespace

Effect temperature_drift() {
  return Effect{
      .id = "temperature_drift",
      .link = Link::structure,
      .equation = "k = k0 (1 + d t / T + e n), n the number of the record",
      .source = "effects.md",
      .confused_with = "sensor_drift; frequency moves here, offset there",
      .form_error = 0.05,
      .needs = {.base = true},
      .parameters = {uniform("within_record", "1", -0.4, 0.4, 0.),
                     normal("between_records", "1", 0., 0.005, -0.1, 0.1, 0.)},
      .starts = {{0.02, 0.}, {-0.02, 0.}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
        chain.joint.push_back([slope = v[0] / scales.duration_s, jump = v[1]](const Lanes& number) {
          return std::make_unique<Drift>(slope, jump * number);
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
