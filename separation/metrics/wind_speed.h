#pragma once

#include <functional>
#include <span>
#include <vector>

namespace vibrissa::separation {

/// Steady moment as a function of wind speed, M = k Cd(Re) u |u| or another form: odd in u,
/// strictly increasing.
class DragCalibration {
 public:
  struct Point {
    double speed_m_s = 0.;
    double moment_n_m = 0.;
  };

  /// moment_of_speed: for 0 <= u <= highest_speed_m_s, zero at zero. relative_error: standard
  /// deviation of the law as a share of the moment (drag coefficient, area). Throws UserError with
  /// the place unless the law is finite and strictly increasing on a grid of 1000 speeds.
  DragCalibration(std::function<double(double)> moment_of_speed, double highest_speed_m_s,
                  double relative_error = 0.);
  /// Calibration from measured points: speeds above zero, both columns strictly increasing. Between
  /// the points, and from zero to the first one, M = u |u| times a factor that is linear in u:
  /// exact for a constant drag coefficient. Throws UserError with the number of the point.
  static DragCalibration from_points(std::vector<Point> points, double relative_error = 0.);

  double moment_n_m(double speed_m_s) const;
  double highest_speed_m_s() const { return highest_speed_m_s_; }
  double highest_moment_n_m() const { return highest_moment_n_m_; }
  double relative_error() const { return relative_error_; }
  /// The speed for a moment of any sign, exact to rounding (bisection); NaN outside the
  /// calibration.
  double speed_m_s(double moment_n_m) const;

 private:
  std::function<double(double)> moment_of_speed_;
  double highest_speed_m_s_, highest_moment_n_m_, relative_error_;
};

/// NaN outside the calibration: there is no extrapolation.
struct WindSpeed {
  double value_m_s = 0.;
  /// Ends of the interval of one standard deviation. It is not symmetric: near zero, a small moment
  /// means a large speed (square law). NaN when an end is outside the calibration.
  double low_m_s = 0., high_m_s = 0.;
};

/// Wind speed from the separated wind moment by inverting the quasi-steady drag law at each sample:
/// value = F^-1(M), ends = F^-1(M - s) and F^-1(M + s) with s^2 = moment_deviation^2 +
/// (relative_error M)^2. Valid when the wind changes slowly compared with the resonance of the
/// sensor, and the speed of the sensor is small compared with the wind speed. Throws UserError for
/// a deviation that is negative or a moment that is not finite. Proven by
/// tests/separation/metrics/wind_speed_test.cc.
std::vector<WindSpeed> wind_speed(const DragCalibration& calibration,
                                  std::span<const double> wind_moment_n_m,
                                  double moment_deviation_n_m);

}  // namespace vibrissa::separation
