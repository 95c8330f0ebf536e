#pragma once

#include <span>
#include <vector>

#include "diagnosis/steady_state/harmonic_balance.h"

namespace vibrissa::diagnosis {

/// All steady states under one drive from one frequency to another, in the order of the curve,
/// which turns back where a sweep jumps. Proven by tests/diagnosis/steady_state/duffing_test.cc.
class ResponseCurve {
 public:
  /// One steady state, with the direction of the curve there (of any length).
  struct Point {
    PeriodicMotion motion{};
    Eigen::VectorXd direction{};
    double direction_rad_s = 0.;
    double peak = 0.;           // largest |y| [N m]
    Eigen::MatrixXd inverse{};  // of the error's derivatives by the coordinates
  };

  /// Follows the curve from the first to the last frequency by its arc length (Seydel 2010,
  /// Practical Bifurcation and Stability Analysis, ch. 4), beginning at the state that grows from
  /// rest with the drive. The number of harmonics rises until those neglected are below this part
  /// of the motion, or to the highest order.
  ResponseCurve(const Chain& chain, const HarmonicDrive& drive, double first_rad_s,
                double last_rad_s, double most_neglected = 1e-3, std::size_t highest_order = 27);

  const HarmonicBalance& balance() const { return *balance_; }
  const std::vector<Point>& points() const { return points_; }
  /// False where the curve could not be followed to the last frequency.
  bool is_complete() const { return is_complete_; }

  /// The steady states at frequencies, each in the order of the curve: interpolated between
  /// its points and corrected. The first is that of a sweep in the curve's direction; every second
  /// one is unstable (a saddle).
  std::vector<std::vector<PeriodicMotion>> at(std::span<const double> w_rad_s) const;

  /// Frequencies at which the curve turns back, where a sweep in its direction jumps, and at which
  /// it turns again, in the order of the curve.
  std::vector<double> folds_rad_s() const;

 private:
  void follow(double first_rad_s, double last_rad_s);
  bool begin(double first_rad_s, double direction);
  double largest_neglected() const;

  std::optional<HarmonicBalance> balance_{};
  std::vector<Point> points_;
  bool is_complete_ = false;
};

}  // namespace vibrissa::diagnosis
