#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

/// A softening spring keeps a tenth of its tangent stiffness: beyond that point it is linear.
class Cubic : public JointLaw {
 public:
  explicit Cubic(double coefficient)
      : coefficient_(coefficient),
        straight_(coefficient < 0. ? std::sqrt(0.3 / -coefficient)
                                   : std::numeric_limits<double>::infinity()) {}
  Lanes moment(const Lanes& y, const Lanes&, const Lanes&, double, bool) override {
    const Lanes bent = y.max(-straight_).min(straight_);
    return coefficient_ * bent * bent * (3. * y - 2. * bent);
  }

 private:
  double coefficient_, straight_;
};

}  // namespace

Effect hardening() {
  return Effect{
      .id = "hardening",
      .about = "the spring stiffens or softens with deflection",
      .link = Link::structure,
      .source = "Nayfeh and Mook 1979, ch. 4; Worden and Tomlinson 2001, sec. 2.3.1 and 3.2",
      .model_form_error = 0.1,
      .needs = {.base = true},
      .parameters = {relative("of the elastic moment at its peak",
                              uniform("cubic_ratio", "1", -0.6, 8., 0.))},
      .starts = {{0.03}, {-0.03}, {0.2}, {0.6}, {1.5}, {4.}, {-0.15}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
        chain.joint.push_back([b = v[0] / (scales.joint_moment_n_m * scales.joint_moment_n_m)](
                                  const Lanes&) { return std::make_unique<Cubic>(b); });
      }};
}

}  // namespace vibrissa::diagnosis::effects
