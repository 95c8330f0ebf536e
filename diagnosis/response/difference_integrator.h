#pragma once

#include <memory>
#include <vector>

#include "diagnosis/model/chain.h"
#include "diagnosis/model/joint_model.h"

namespace vibrissa::diagnosis {

/// (u - v) |u - v| - u |u|, v = base_share base_velocity + velocity_per_moment_rate moment_rate
/// [(m/s)^2]. moment_rate: of the joint's elastic moment [N m / s].
inline Lanes relative_drag(const RelativeWind& moving, const Lanes& u, const Lanes& base_velocity,
                           const Lanes& moment_rate) {
  const Lanes felt =
      u - moving.base_share * base_velocity - moving.velocity_per_moment_rate * moment_rate;
  return felt * felt.abs() - u * u.abs();
}

/// Integrates the addition by joint laws and relative wind to the linear part, whose elastic joint
/// moment is given; one record per lane. A step consists of begin, correct (repeated until
/// is_open() is false) and end. The chain must outlive this object. Proven by
/// tests/diagnosis/prediction/chain_simulation_test.cc and
/// tests/diagnosis/steady_state/duffing_test.cc.
class DifferenceIntegrator {
 public:
  DifferenceIntegrator(const Chain& chain, const JointModel& joint, const Lanes& record_number,
                       double dt)
      : dt_(dt), is_loaded_(chain.relative_wind.on), integrator_(joint, dt) {
    for (const JointLawMaker& maker : chain.joint) laws_.push_back(maker(record_number));
  }

  /// Tells the laws the largest elastic moment before the start.
  void remember_peak(const Lanes& peak) {
    for (const auto& law : laws_) law->remember_peak(peak);
  }
  /// State of the addition at the end of the last step: theta and its rate per second.
  const Lanes& theta() const { return integrator_.theta(); }
  Lanes theta_rate() const { return integrator_.theta_rate(); }
  /// Additions from which the integration goes on, instead of rest.
  void start(const JointIntegrator::State& state, const Lanes& torque, const Lanes& external) {
    integrator_.start(state, torque, external);
    torque_ = torque_before_ = torque;
    external_ = external;
  }
  /// Tells the laws a step that was made before the start.
  void remember(const Lanes& y, const Lanes& y_rate, const Lanes& t_s) {
    for (const auto& law : laws_) law->moment(y, y_rate, t_s, dt_, true);
  }

  /// Begins a step to (y, y_rate) of the linear part at times t_s.
  void begin(const Lanes& y, const Lanes& y_rate, const Lanes& t_s) {
    y_ = y;
    y_rate_ = y_rate;
    t_s_ = t_s;
    n_corrections_ = 0;
    if (!laws_.empty()) begin_torque();
  }

  /// Was the residual before the last correction large in any lane? The residual after it is far
  /// smaller.
  bool is_open() const {
    constexpr double tolerance = 1e-5;
    constexpr int most_corrections = 4;
    if (laws_.empty() || n_corrections_ == most_corrections) return false;
    return (from_excess_.abs() - tolerance * at_.abs()).maxCoeff() > 0.;
  }

  void correct() {
    ++n_corrections_;
    const Lanes at_excess = law_moment(at_, false) - at_;
    const Lanes slopes = (at_excess - from_excess_) / (at_ - from_);
    from_ = at_;
    from_excess_ = at_excess;
    slope_ = where_negative(slopes, slopes, slope_);
    at_ -= where_negative(slopes, at_excess, Lanes::Zero()) / slope_;
  }

  /// load gives the additional wind load for a rate of the joint moment. Returns the change of the
  /// base moment.
  template <typename Load>
  JointIntegrator::AtBase end(const Load& load) {
    if (laws_.empty()) {
      for (int pass = 0; pass < 2; ++pass)
        external_ = load(y_rate_ + integrator_.elastic_rate(torque_, external_));
      return integrator_.accept(torque_, external_);
    }
    torque_before_ = torque_;
    torque_ = at_;
    if (is_loaded_) external_ = load(y_rate_ + integrator_.elastic_rate(torque_, external_));
    law_moment(torque_, true);
    return integrator_.accept(torque_, external_);
  }

 private:
  /// The additional moment at the step's end changes the joint's rotation at the same time, so a
  /// stiff law needs the implicit solution of T = law(y(T)), by the secant method from an
  /// extrapolation of the previous steps.
  void begin_torque() {
    from_ = 2. * torque_ - torque_before_;
    from_excess_ = law_moment(from_, false) - from_;
    at_ = from_ - from_excess_ / slope_;
  }

  Lanes law_moment(const Lanes& assumed, bool commit) {
    const Lanes elastic = y_ + integrator_.elastic(assumed, external_);
    const Lanes rate = y_rate_ + integrator_.elastic_rate(assumed, external_);
    Lanes sum = Lanes::Zero();
    for (const auto& law : laws_) sum += law->moment(elastic, rate, t_s_, dt_, commit);
    return sum;
  }

  double dt_;
  bool is_loaded_;
  JointIntegrator integrator_;
  std::vector<std::unique_ptr<JointLaw>> laws_;
  Lanes torque_ = Lanes::Zero(), torque_before_ = Lanes::Zero(), external_ = Lanes::Zero();
  Lanes slope_ = Lanes::Constant(-1.);  // of law(y(T)) - T, at the previous step
  // State of the step in progress.
  Lanes y_ = Lanes::Zero(), y_rate_ = Lanes::Zero(), t_s_ = Lanes::Zero();
  Lanes from_ = Lanes::Zero(), from_excess_ = Lanes::Zero(), at_ = Lanes::Zero();
  int n_corrections_ = 0;
};

}  // namespace vibrissa::diagnosis
