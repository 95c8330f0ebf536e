#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "diagnosis/model/lanes.h"
#include "diagnosis/model/nominal_model.h"

namespace vibrissa::diagnosis {

/// Transfer function of the continuous signals, s = j 2 pi f.
using Filter = std::function<Complex(Complex s)>;

/// What the joint at the base does beyond its nominal spring and damper. The state is in moments:
/// y = nominal elastic joint moment k0 phi [N m], y_rate its derivative. One object serves one set
/// of records; each lane has a memory of its own.
class JointLaw {
 public:
  virtual ~JointLaw() = default;
  /// Extra moment [N m] at the end of a step of length dt that ends at time t_s of each record.
  /// commit: the step is final, memory may be moved on.
  virtual Lanes moment(const Lanes& y, const Lanes& y_rate, const Lanes& t_s, double dt,
                       bool commit) = 0;
};
/// Makes the law for records; their numbers count them in the order of the dataset.
using JointLawMaker = std::function<std::unique_ptr<JointLaw>(const Lanes& record_number)>;

/// Factors on the parts of the first mode's joint model.
struct JointChange {
  double spring = 1., damper = 1.;  // of the joint
  double rest_damping = 1.;         // of the damping that is not in the joint
  double inertia = 1.;
  bool any() const { return spring != 1. || damper != 1. || rest_damping != 1. || inertia != 1.; }
};

/// Wind that a moving whisker feels: F = (u - v) |u - v| in place of u |u|, v = base_share times
/// the base velocity + velocity_per_moment_rate times the rate of the first mode's joint moment.
struct RelativeWind {
  bool on = false;
  double base_share = 1.;  // negative where the wind blows against the axis of the base motion
  double velocity_per_moment_rate = 0.;  // (m/s) / (N m / s)
};

/// What a noise of its own does to one record's spectrum: the variance of a DFT bin is added to.
struct RecordView {
  bool base = false, wind = false;  // excited?
  double sampling_rate_hz = 0.;
  std::size_t n_samples = 0;             // of the DFT
  std::span<const double> wind_speed{};  // m/s, empty when not measured
  /// wind response of the chain at bin k [N m / (m/s)^2]
  std::function<Complex(std::size_t k)> wind_response;
};
/// Variance E|N_k|^2 of the bins k = 1 .. of an unscaled DFT [(N m)^2], added to variance.
using NoiseSource = std::function<void(const RecordView&, std::span<double> variance)>;

/// The measuring chain from what the reference accelerometer and the anemometer *read* to what the
/// moment sensor reads: reference -> mount -> structure <- wind; structure -> sensor -> clock.
/// Effects extend it; without effects it is the nominal simulator.
struct Chain {
  /// Share of what the accelerometer's source gave, at its own rate, in place of what was polled.
  double new_sample_share = 0.;
  std::vector<Filter> reference{};  // reading -> true acceleration at the accelerometer
  std::vector<Filter> mount{};      // there -> base
  NominalModel structure{};
  /// Share p of the joint in the compliance of the first mode: 1 for a rigid whisker on a spring,
  /// less for a flexible one. The simulation's records do not determine it.
  double joint_share = 1.;
  /// Factor on the joint's share in the damping of the first mode that its viscous moment tells.
  double joint_loss_factor = 1.;
  JointChange joint_change{};
  /// Factor on the joint's stiffness that the structure's modes hold already: the moment of a unit
  /// of its rotation.
  double joint_stiffness = 1.;
  /// The joint's spring and damper K(s) become K(s) (1 + D(s)), D the sum of these.
  std::vector<Filter> relaxation{};
  /// Likewise, by a spring under the joint, whose rotation no sensor reads.
  std::vector<Filter> support{};
  std::vector<Filter> parallel{};  // further paths base acceleration -> moment
  std::vector<JointLawMaker> joint{};
  RelativeWind relative_wind{};
  std::vector<std::function<void(std::span<double> wind, double dt)>>
      wind{};  // reading -> at whisker
  double drag_factor = 1.;
  std::vector<Filter> feedthrough{};  // true acceleration -> added reading
  std::vector<Filter> cross{};        // transverse acceleration -> added moment
  std::vector<std::function<double(double moment)>> readout{};  // static law of the sensor
  std::vector<Filter> sensor{};                                 // moment -> reading
  double clock_rate_error = 0.;  // moment channel sampled at t (1 + this), t since the clocks began
  double reference_variance = 0.;  // of accelerometer noise beyond the usual, a sample [(m/s^2)^2]
  std::vector<NoiseSource> noise{};
  /// Of the straight line that a random walk draws from a record's start to its end: variance of
  /// its rise a second [(N m)^2 / s].
  double ramp_variance_rate = 0.;
};

}  // namespace vibrissa::diagnosis
