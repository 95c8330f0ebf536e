#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "diagnosis/response/linear_response.h"
#include "diagnosis/steady_state/fourier_basis.h"

namespace vibrissa::diagnosis {

/// A sine of the base, in steady wind or none.
struct HarmonicDrive {
  double acceleration_m_s2 = 0.;  // amplitude of the accelerometer's reading
  std::function<double(double w_rad_s)> relative_level{};  // factor on it; nothing: 1
  std::optional<double> wind_speed_m_s{};                  // nothing: not measured
  signals::Readout readout = signals::Readout::moment;
  std::size_t record_number = 0;  // of the laws that change from record to record
  double earlier_peak_n_m = 0.;   // largest elastic moment before, for laws that stay changed

  double acceleration_at(const double w_rad_s) const {
    return acceleration_m_s2 * (relative_level ? relative_level(w_rad_s) : 1.);
  }
};

/// A periodic motion: coordinates of the joint's elastic moment y [N m], its frequency, and the
/// largest elastic moment before it.
struct PeriodicMotion {
  Eigen::VectorXd y{};
  double w_rad_s = 0.;
  double earlier_peak = 0.;
};

/// Steady state of a chain under a sine by harmonic balance, with alternating frequency and time
/// (Cameron and Griffin 1989, J. Appl. Mech. 56, 149-154): with the linear part Y_lin, the laws'
/// moment T and the load E of relative wind,
///   Y_k = Y_lin,k + (dY / dT)(j k w) T_k + (dY / dE)(j k w) E_k.
/// Laws with memory are evaluated over the second of two periods. The equations are those of
/// joint_simulation.h. The chain must outlive this object. Proven by
/// tests/diagnosis/steady_state/time_integration_test.cc.
class HarmonicBalance {
 public:
  HarmonicBalance(const Chain& chain, const HarmonicDrive& drive, std::size_t highest_order);

  const FourierBasis& basis() const { return basis_; }
  const Chain& chain() const { return chain_; }
  const HarmonicDrive& drive() const { return drive_; }
  /// The joint, as it is integrated in time.
  const JointModel& joint() const { return joint_; }
  /// Can the branches of one direction serve the other?
  bool has_memory() const { return has_memory_; }

  /// Error of the equations at a motion, its derivatives and the motion's peak.
  struct Linearised {
    Eigen::VectorXd error, by_frequency;
    Eigen::MatrixXd by_coordinates;
    double peak = 0.;  // largest |y| [N m]
  };
  /// drive_share: of the acceleration's amplitude.
  Linearised linearised(const PeriodicMotion& motion, double drive_share = 1.) const;

  /// Coordinates of the linear part.
  Eigen::VectorXd linear_motion(double w_rad_s, double drive_share = 1.) const;
  /// Laws' moment and relative wind's load of a motion, as coordinates.
  struct Loads {
    Eigen::VectorXd torque, external;
  };
  Loads loads(const PeriodicMotion& motion) const;
  /// Fundamental of the reading [N m], relative to the phase of the acceleration's reading. At most
  /// signals::n_lanes motions.
  std::vector<Complex> readings(std::span<const PeriodicMotion> motions) const;
  /// Error of the equations at each motion; at most signals::n_lanes motions.
  std::vector<Eigen::VectorXd> errors(std::span<const PeriodicMotion> motions) const;
  /// Chord iterations from motions, at most signals::n_lanes, each with an inverse of the error's
  /// derivatives by the coordinates near by. Each stays where its next step would be larger.
  void correct(std::span<PeriodicMotion> motions, std::span<const Eigen::MatrixXd* const> inverse,
               int n_iterations) const;
  /// Norm of the motion that the orders beyond the highest would add, relative to the motion.
  std::vector<double> neglected(std::span<const PeriodicMotion> motions) const;

 private:
  /// What the equations need at one frequency; of each order.
  struct Coefficients {
    Eigen::VectorXd linear;
    std::vector<Complex> torque, external;
  };
  struct LaneLoads {
    LaneRows torque, external;
    Lanes peak;
  };
  Coefficients coefficients(double w_rad_s, double drive_share) const;
  LaneLoads lane_loads(const LaneRows& y, const Lanes& w_rad_s, const Lanes& earlier_peak,
                       double drive_share) const;
  std::vector<Eigen::VectorXd> errors(std::span<const PeriodicMotion> motions,
                                      std::span<const Coefficients> coefficients) const;
  std::vector<Coefficients> coefficients_of(std::span<const PeriodicMotion> motions) const;
  Eigen::VectorXd linear_motion(double w_rad_s, double drive_share, const LinearPart& part) const;
  Eigen::VectorXd error(const Eigen::VectorXd& y, const Coefficients& coefficients,
                        const LaneLoads& loads, Eigen::Index lane) const;
  Complex reading(const PeriodicMotion& motion, const LaneLoads& loads, Eigen::Index lane) const;

  const Chain& chain_;
  HarmonicDrive drive_;
  LinearResponse response_;
  JointModel joint_;
  FourierBasis basis_;
  bool has_memory_ = false;
  double wind_gain_ = 0.;
  double steady_elastic_ = 0., steady_moment_ = 0.;  // of the linear part, by steady wind [N m]
};

}  // namespace vibrissa::diagnosis
