#pragma once

#include <functional>
#include <span>
#include <vector>

namespace vibrissa::separation {

/// Steady moment of a wind speed, M = k Cd(Re) u |u| in any form: odd in u, strictly rising.
class DragCalibration {
 public:
  struct Point {
    double speed_m_s = 0.;
    double moment_n_m = 0.;
  };

  /// moment_of_speed: for 0 <= u <= highest_speed_m_s, zero at zero. relative_error: standard
  /// deviation of the law as a share of the moment (drag coefficient, area). Throws UserError with
  /// the place unless the law is finite and strictly rising on a grid of 1000 speeds.
  DragCalibration(std::function<double(double)> moment_of_speed, double highest_speed_m_s,
                  double relative_error = 0.);
  /// Measured points, speeds above zero, both columns strictly rising. Between them, and from zero
  /// to the first, M = u |u| times a factor that runs straight in u: exact for a constant drag
  /// coefficient. Throws UserError with the point's number.
  static DragCalibration from_points(std::vector<Point> points, double relative_error = 0.);

  double moment_n_m(double speed_m_s) const;
  double highest_speed_m_s() const { return highest_speed_m_s_; }
  double highest_moment_n_m() const { return highest_moment_n_m_; }
  double relative_error() const { return relative_error_; }
  /// The speed of a moment of either sign, to rounding (bisection); NaN beyond the calibration.
  double speed_m_s(double moment_n_m) const;

 private:
  std::function<double(double)> moment_of_speed_;
  double highest_speed_m_s_, highest_moment_n_m_, relative_error_;
};

/// NaN where the calibration does not reach: it is never continued beyond its end.
struct WindSpeed {
  double value_m_s = 0.;
  /// Ends of the interval of one standard deviation. Not symmetric: near zero the square law makes
  /// a small moment a large speed. NaN when that end lies beyond the calibration.
  double low_m_s = 0., high_m_s = 0.;
};

/// Wind speed from the separated wind moment by inverting the quasi-steady drag law at each sample:
/// value = F^-1(M), ends = F^-1(M -+ s) with s^2 = moment_deviation^2 + (relative_error M)^2.
/// Valid where the wind changes slowly against the sensor's resonance and the sensor's own
/// speed is small against the wind. Throws UserError for a deviation that is negative or a moment
/// that is not finite. Proven by tests/separation/metrics/wind_speed_test.cc.
std::vector<WindSpeed> wind_speed(const DragCalibration& calibration,
                                  std::span<const double> wind_moment_n_m,
                                  double moment_deviation_n_m);

}  // namespace vibrissa::separation
