#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "diagnosis/model/nominal_model.h"
#include "signals/base/lanes.h"

namespace vibrissa::diagnosis {

using signals::Lanes;  // one value for each record that is integrated
using signals::where_negative;

/// Transfer function of the continuous signals, s = j 2 pi f.
using Filter = std::function<Complex(Complex s)>;

/// Law of the joint at the base in addition to its nominal spring and damper. The state is in
/// moments: y = nominal elastic joint moment k0 phi [N m], y_rate its derivative. One object serves
/// one set of records; each lane has its own memory.
class JointLaw {
 public:
  virtual ~JointLaw() = default;
  /// Extra moment [N m] at the end of a step of length dt that ends at time t_s of each record.
  /// commit: the step is final, so the memory is updated.
  virtual Lanes moment(const Lanes& y, const Lanes& y_rate, const Lanes& t_s, double dt,
                       bool commit) = 0;
  /// Does the moment depend on earlier steps?
  virtual bool has_memory() const { return true; }
  /// The joint had been strained to this elastic moment [N m] before, for laws that stay changed.
  virtual void remember_peak(const Lanes&) {}
};
/// Creates the law for records, given their numbers in the order of the dataset.
using JointLawMaker = std::function<std::unique_ptr<JointLaw>(const Lanes& record_number)>;

/// Factors on the parameters of the first mode's joint model.
struct JointChange {
  double spring = 1., damper = 1.;  // of the joint
  double rest_damping = 1.;         // of the damping outside the joint
  double inertia = 1.;
  bool any() const { return spring != 1. || damper != 1. || rest_damping != 1. || inertia != 1.; }
};

/// Wind relative to the moving whisker: F = (u - v) |u - v| instead of u |u|, with v = base_share
/// times the base velocity + velocity_per_moment_rate times the rate of the first mode's joint
/// moment.
struct RelativeWind {
  bool on = false;
  double base_share = 1.;  // negative when the wind blows against the axis of the base motion
  double velocity_per_moment_rate = 0.;  // (m/s) / (N m / s)
};

/// A record as seen by a process noise, which adds variance to its DFT bins.
struct RecordView {
  bool base = false, wind = false;  // excited?
  double sampling_rate_hz = 0.;
  std::size_t n_samples = 0;             // of the DFT
  std::span<const double> wind_speed{};  // m/s, empty when not measured
  /// Wind response of the chain at bin k [N m / (m/s)^2].
  std::function<Complex(std::size_t k)> wind_response;
};
/// Variance E|N_k|^2 of the bins k = 1 .. of an unscaled DFT [(N m)^2], added to variance.
using NoiseSource = std::function<void(const RecordView&, std::span<double> variance)>;

/// A sine in the reading, whose cosine and sine parts are independent and normal in each record.
struct Tone {
  double amplitude = 0.;  // sqrt(2) times the root mean square [N m]
  double frequency_hz = 0.;
};

/// The measuring chain from the readings of the reference accelerometer and the anemometer to the
/// reading of the moment sensor: reference -> mount -> structure <- wind; structure -> sensor ->
/// clock. Effects extend it; without effects it is the nominal model.
struct Chain {
  /// Share of the accelerometer source's own samples, at its own rate, that replaces the
  /// sample-and-hold repeats.
  double new_sample_share = 0.;
  std::vector<Filter> reference{};  // reading -> true acceleration at the accelerometer
  std::vector<Filter> mount{};      // acceleration at the accelerometer -> base
  NominalModel structure{};
  /// Share p of the joint in the compliance of the first mode: 1 for a rigid whisker on a spring,
  /// less for a flexible whisker. The simulation's records do not determine it.
  double joint_share = 1.;
  /// Part of 1 - joint_share that the joint has in the elastic energy of the modes above the first.
  double higher_joint_share = 0.;
  /// Factor on the joint's share in the damping of the first mode, which follows from its viscous
  /// moment.
  double joint_loss_factor = 1.;
  JointChange joint_change{};
  /// Factor on the joint's stiffness that the structure's modes already include: moment per unit of
  /// joint rotation.
  double joint_stiffness = 1.;
  /// The joint's spring and damper K(s) become K(s) (1 + D(s)), D the sum of these.
  std::vector<Filter> relaxation{};
  /// The same for a spring under the joint, whose rotation no sensor reads.
  std::vector<Filter> support{};
  std::vector<Filter> parallel{};  // further paths base acceleration -> moment
  std::vector<JointLawMaker> joint{};
  RelativeWind relative_wind{};
  std::vector<std::function<void(std::span<double> wind, double dt)>>
      wind{};  // reading -> wind at the whisker
  double drag_factor = 1.;
  std::vector<Filter> feedthrough{};  // true acceleration -> addition to the reading
  std::vector<Filter> cross{};        // transverse acceleration -> additional moment
  std::vector<std::function<double(double moment)>> readout{};  // static law of the sensor
  std::vector<Filter> sensor{};                                 // moment -> reading
  double clock_rate_error =
      0.;  // moment channel is sampled at t (1 + this), t since the start of the clocks
  double reference_variance = 0.;  // additional accelerometer noise per sample [(m/s^2)^2]
  std::vector<NoiseSource> noise{};
  /// Variance per second of a random walk's rise between a record's start and end [(N m)^2 / s].
  double ramp_variance_rate = 0.;
  std::vector<Tone> tones{};
};

}  // namespace vibrissa::diagnosis
