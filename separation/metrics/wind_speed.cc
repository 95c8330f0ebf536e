#include "separation/metrics/wind_speed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::to_text;
using signals::UserError;

double not_negative(double value, const std::string& name) {
  if (!(value >= 0. && std::isfinite(value)))
    throw UserError("wind speed: " + name + " = " + to_text(value) +
                    " must be finite and not negative");
  return value;
}

void check_rising(const std::function<double(double)>& law, double highest_speed) {
  if (!(highest_speed > 0. && std::isfinite(highest_speed)))
    throw UserError("wind speed: highest_speed_m_s = " + to_text(highest_speed) +
                    " must be positive and finite");
  if (law(0.) != 0.)
    throw UserError("wind speed: the drag law gives " + to_text(law(0.)) +
                    " N m at rest, but it must give 0");
  constexpr int n_speeds = 1000;
  double last = 0.;
  for (int i = 1; i <= n_speeds; ++i) {
    const double speed = highest_speed * i / n_speeds, moment = law(speed);
    if (!(moment > last) || !std::isfinite(moment))
      throw UserError("wind speed: the drag law does not increase at " + to_text(speed) + " m/s (" +
                      to_text(moment) + " N m after " + to_text(last) +
                      " N m), so several speeds would have the same moment");
    last = moment;
  }
}

void check_points(const std::vector<DragCalibration::Point>& points) {
  if (points.empty()) throw UserError("wind speed: the calibration has no points");
  DragCalibration::Point last;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& point = points[i];
    if (!(point.speed_m_s > last.speed_m_s && point.moment_n_m > last.moment_n_m) ||
        !std::isfinite(point.speed_m_s) || !std::isfinite(point.moment_n_m))
      throw UserError("wind speed: calibration point " + std::to_string(i + 1) + " (" +
                      to_text(point.speed_m_s) + " m/s, " + to_text(point.moment_n_m) +
                      " N m) must be above zero and above the point before it");
    last = point;
  }
}

double factor_of(const DragCalibration::Point& point) {
  return point.moment_n_m / (point.speed_m_s * point.speed_m_s);
}

double interpolate(const std::vector<DragCalibration::Point>& points, double speed) {
  const auto above =
      std::ranges::lower_bound(points, speed, {}, &DragCalibration::Point::speed_m_s);
  if (above == points.begin()) return factor_of(points.front()) * speed * speed;
  if (above == points.end()) return factor_of(points.back()) * speed * speed;
  const auto below = above - 1;
  const double share = (speed - below->speed_m_s) / (above->speed_m_s - below->speed_m_s);
  return std::lerp(factor_of(*below), factor_of(*above), share) * speed * speed;
}

}  // namespace

DragCalibration::DragCalibration(std::function<double(double)> moment_of_speed,
                                 double highest_speed_m_s, double relative_error)
    : moment_of_speed_(std::move(moment_of_speed)),
      highest_speed_m_s_(highest_speed_m_s),
      relative_error_(not_negative(relative_error, "relative_error")) {
  check_rising(moment_of_speed_, highest_speed_m_s);
  highest_moment_n_m_ = moment_of_speed_(highest_speed_m_s);
}

DragCalibration DragCalibration::from_points(std::vector<Point> points, double relative_error) {
  check_points(points);
  const double highest = points.back().speed_m_s;
  return {[points = std::move(points)](double speed) { return interpolate(points, speed); },
          highest, relative_error};
}

double DragCalibration::moment_n_m(double speed_m_s) const {
  return std::copysign(moment_of_speed_(std::abs(speed_m_s)), speed_m_s);
}

double DragCalibration::speed_m_s(double moment_n_m) const {
  const double moment = std::abs(moment_n_m);
  if (!(moment <= highest_moment_n_m_)) return std::numeric_limits<double>::quiet_NaN();
  double low = 0., high = highest_speed_m_s_;
  for (double middle = 0.5 * high; low < middle && middle < high; middle = 0.5 * (low + high))
    (moment_of_speed_(middle) < moment ? low : high) = middle;
  return std::copysign(moment == 0. ? 0. : high, moment_n_m);
}

std::vector<WindSpeed> wind_speed(const DragCalibration& calibration,
                                  std::span<const double> wind_moment_n_m,
                                  double moment_deviation_n_m) {
  not_negative(moment_deviation_n_m, "moment_deviation_n_m");
  std::vector<WindSpeed> speeds;
  speeds.reserve(wind_moment_n_m.size());
  for (const double moment : wind_moment_n_m) {
    if (!std::isfinite(moment))
      throw UserError("wind speed: the wind moment is not finite at sample " +
                      std::to_string(speeds.size()));
    const double deviation =
        std::hypot(moment_deviation_n_m, calibration.relative_error() * moment);
    speeds.push_back({.value_m_s = calibration.speed_m_s(moment),
                      .low_m_s = calibration.speed_m_s(moment - deviation),
                      .high_m_s = calibration.speed_m_s(moment + deviation)});
  }
  return speeds;
}

}  // namespace vibrissa::separation
