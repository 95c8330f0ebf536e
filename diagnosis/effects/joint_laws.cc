#include <array>

#include "diagnosis/model/effect.h"
#include "diagnosis/model/joint_model.h"

namespace vibrissa::diagnosis::effects {
namespace {

class DeadZone : public JointLaw {
 public:
  DeadZone(double gap, double loss) : gap_(gap), loss_(loss) {}
  Lanes moment(const Lanes& y, const Lanes&, const Lanes&, double, bool) override {
    return -loss_ * y.max(-gap_).min(gap_);
  }
  bool has_memory() const override { return false; }

 private:
  double gap_, loss_;
};

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
  bool has_memory() const override { return false; }

 private:
  double coefficient_, straight_;
};

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

class Softening : public JointLaw {
 public:
  Softening(double depth, double level) : depth_(depth), level_(level) {}
  Lanes moment(const Lanes& y, const Lanes&, const Lanes&, double, bool commit) override {
    if (commit) remember_peak(y.abs());
    return factor_ * y;
  }
  void remember_peak(const Lanes& peak) override {
    if (!(peak > largest_).any()) return;
    largest_ = largest_.max(peak);
    factor_ = -depth_ * (1. - (-largest_ / level_).exp());
  }

 private:
  double depth_, level_;
  Lanes largest_ = Lanes::Zero(), factor_ = Lanes::Zero();
};

class Drift : public JointLaw {
 public:
  Drift(const Lanes& slope, const Lanes& offset, double loss_s)
      : slope_(slope), offset_(offset), loss_s_(loss_s) {}
  Lanes moment(const Lanes& y, const Lanes& y_rate, const Lanes& t_s, double, bool) override {
    return (offset_ + slope_ * t_s) * (y + loss_s_ * y_rate);
  }
  bool has_memory() const override { return false; }

 private:
  Lanes slope_, offset_;
  double loss_s_;
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
      .equivalent_stiffness = [](std::span<const double> v) { return 1. + v[0] / 3.; },
      .extend =
          [](Chain& chain, std::span<const double> v, const Scales& scales) {
            chain.joint.push_back([b = v[0] / (scales.joint_moment_n_m * scales.joint_moment_n_m)](
                                      const Lanes&) { return std::make_unique<Cubic>(b); });
          }};
}

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
