#include "diagnosis/steady_state/response_curve.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

namespace vibrissa::diagnosis {
namespace {

using Linearised = HarmonicBalance::Linearised;

constexpr int most_iterations = 8;
constexpr double converged_step = 1e-5;  // relative; the error after it is about its square
/// A step of the arc length is in shares of the motion and of this part of the frequency.
constexpr double frequency_share = 0.05;

/// Newton's method at one frequency.
bool solve(const HarmonicBalance& balance, PeriodicMotion& motion, const double drive_share) {
  for (int i = 0; i < most_iterations; ++i) {
    const Linearised at = balance.linearised(motion, drive_share);
    const Eigen::VectorXd step = at.by_coordinates.partialPivLu().solve(at.error);
    motion.y -= step;
    if (!motion.y.allFinite()) return false;
    if (step.norm() <= converged_step * motion.y.norm()) return true;
  }
  return false;
}

/// The motion that grows with the drive from rest, so that of two it is the smaller one; where that
/// one ends before, another one.
std::optional<PeriodicMotion> first_motion(const HarmonicBalance& balance, const double w_rad_s) {
  const Eigen::VectorXd linear = balance.linear_motion(w_rad_s);
  const double earlier_peak = balance.drive().earlier_peak_n_m;
  PeriodicMotion motion{.y = 0.1 * linear, .w_rad_s = w_rad_s, .earlier_peak = earlier_peak};
  double share = 0.;
  for (double step = 0.25; share < 1. && step > 1e-3;) {
    PeriodicMotion next = motion;
    const double next_share = std::min(1., share + step);
    if (solve(balance, next, next_share)) {
      share = next_share;
      motion = next;
    } else {
      step *= 0.5;
    }
  }
  if (share == 1.) return motion;
  for (const double factor : {1., 3., 0.3, 10., 0.1, -1., -3., -0.3, 30.}) {
    motion.y = factor * linear;
    if (solve(balance, motion, 1.)) return motion;
  }
  return {};
}

/// The arc length between and along points, in the scales of one of them.
class ArcScale {
 public:
  explicit ArcScale(const PeriodicMotion& motion)
      : y_(1. / motion.y.norm()), w_(1. / (frequency_share * motion.w_rad_s)) {}

  Eigen::VectorXd scaled(const Eigen::VectorXd& y, const double w) const {
    Eigen::VectorXd out(y.size() + 1);
    out << y * y_, w * w_;
    return out;
  }
  void move(PeriodicMotion& motion, const Eigen::VectorXd& step) const {
    motion.y += step.head(motion.y.size()) / y_;
    motion.w_rad_s += step(motion.y.size()) / w_;
  }
  /// Derivatives of the error by the scaled coordinates, with the row of another condition.
  Eigen::MatrixXd bordered(const Linearised& at, const Eigen::VectorXd& row) const {
    const Eigen::Index n = at.error.size();
    Eigen::MatrixXd out(n + 1, n + 1);
    out.topLeftCorner(n, n) = at.by_coordinates / y_;
    out.topRightCorner(n, 1) = at.by_frequency / w_;
    out.bottomRows(1) = row.transpose();
    return out;
  }

 private:
  double y_, w_;
};

/// Direction of the curve with a positive component along the former direction, of length 1.
Eigen::VectorXd unit_direction(const Eigen::MatrixXd& bordered) {
  Eigen::VectorXd right = Eigen::VectorXd::Zero(bordered.rows());
  right(right.size() - 1) = 1.;
  return bordered.partialPivLu().solve(right).normalized();
}

struct Corrected {
  ResponseCurve::Point point;
  Eigen::VectorXd direction;  // scaled
  int n_iterations = 0;
};

/// From a prediction at right angles to its direction back to the curve.
std::optional<Corrected> corrected(const HarmonicBalance& balance, const ArcScale& scale,
                                   PeriodicMotion motion, const Eigen::VectorXd& direction) {
  for (int i = 1; i <= most_iterations; ++i) {
    const Linearised at = balance.linearised(motion);
    const Eigen::MatrixXd bordered = scale.bordered(at, direction);
    Eigen::VectorXd error = Eigen::VectorXd::Zero(bordered.rows());
    error.head(at.error.size()) = at.error;
    const Eigen::VectorXd step = -bordered.partialPivLu().solve(error);
    if (!step.allFinite() || step.norm() > 1.) return {};
    scale.move(motion, step);
    if (!(motion.w_rad_s > 0.)) return {};
    if (step.norm() <= converged_step)
      return Corrected{
          .point = {.motion = motion, .peak = at.peak, .inverse = at.by_coordinates.inverse()},
          .direction = unit_direction(bordered),
          .n_iterations = i};
  }
  return {};
}

/// Values and rates of the cubic polynomial between two ends: weights of both values and slopes.
struct CubicWeights {
  double from, to, slope_from, slope_to;
};
CubicWeights cubic(const double t) {
  const double r = 1. - t;
  return {(1. + 2. * t) * r * r, t * t * (3. - 2. * t), t * r * r, -t * t * r};
}

/// The curve between two of its points.
class Segment {
 public:
  Segment(const ResponseCurve::Point& from, const ResponseCurve::Point& to) : from_(from), to_(to) {
    const ArcScale scale(from.motion);
    length_ =
        scale.scaled(to.motion.y - from.motion.y, to.motion.w_rad_s - from.motion.w_rad_s).norm();
    slope_from_ = length_ / scale.scaled(from.direction, from.direction_rad_s).norm();
    slope_to_ = length_ / scale.scaled(to.direction, to.direction_rad_s).norm();
  }

  double frequency(const double t) const {
    const CubicWeights c = cubic(t);
    return c.from * from_.motion.w_rad_s + c.to * to_.motion.w_rad_s +
           c.slope_from * slope_from_ * from_.direction_rad_s +
           c.slope_to * slope_to_ * to_.direction_rad_s;
  }
  PeriodicMotion motion(const double t, const double w) const {
    const CubicWeights c = cubic(t);
    return {
        .y = c.from * from_.motion.y + c.to * to_.motion.y +
             c.slope_from * slope_from_ * from_.direction + c.slope_to * slope_to_ * to_.direction,
        .w_rad_s = w,
        .earlier_peak = std::max(from_.motion.earlier_peak, (1. - t) * from_.peak + t * to_.peak)};
  }
  /// Where the frequency turns back inside; nothing where it does not.
  std::optional<double> turn() const {
    if (from_.direction_rad_s * to_.direction_rad_s >= 0.) return {};
    double a = 0., b = 1.;
    constexpr double golden = 0.3819660112501051;
    const double sign = from_.direction_rad_s > 0. ? 1. : -1.;
    for (int i = 0; i < 60; ++i) {
      const double c = a + golden * (b - a), d = b - golden * (b - a);
      (sign * frequency(c) > sign * frequency(d) ? b : a) =
          sign * frequency(c) > sign * frequency(d) ? d : c;
    }
    return 0.5 * (a + b);
  }
  /// Where the curve passes a frequency.
  struct Crossing {
    std::size_t line;  // of the frequency
    double t;          // parameter of the segment
  };
  /// In the order of the frequencies; by bisection within each part that does not turn.
  std::vector<Crossing> crossings(std::span<const double> w_rad_s) const {
    constexpr double narrow = 1e-9;
    std::vector<Crossing> out;
    const double middle = turn().value_or(1.);
    for (const auto& [low, high] : {std::array{0., middle}, std::array{middle, 1.}}) {
      const double from = frequency(low), to = frequency(high);
      for (std::size_t line = 0; high > low && line < w_rad_s.size(); ++line) {
        const double at_low = from - w_rad_s[line], at_high = to - w_rad_s[line];
        // A point of the curve belongs to the segment that begins there.
        if ((at_low != 0. && at_low * at_high >= 0.) || at_low == at_high) continue;
        double a = low, b = high;
        while (at_low != 0. && b - a > narrow) {
          const double c = 0.5 * (a + b);
          ((frequency(c) - w_rad_s[line]) * at_low > 0. ? a : b) = c;
        }
        out.push_back({line, a});
      }
    }
    std::ranges::stable_sort(out, {}, &Crossing::line);
    return out;
  }

 private:
  const ResponseCurve::Point &from_, &to_;
  double length_ = 0., slope_from_ = 0., slope_to_ = 0.;
};

}  // namespace

ResponseCurve::ResponseCurve(const Chain& chain, const HarmonicDrive& drive,
                             const double first_rad_s, const double last_rad_s,
                             const double most_neglected, const std::size_t highest_order) {
  for (const std::size_t highest : {3U, 5U, 9U, 15U, 27U}) {
    if (highest > highest_order) return;
    balance_.emplace(chain, drive, highest);
    points_.clear();
    follow(first_rad_s, last_rad_s);
    if (largest_neglected() < most_neglected) return;
  }
}

double ResponseCurve::largest_neglected() const {
  // Neighbouring points differ little.
  constexpr std::size_t step = 3;
  double largest = 0.;
  std::vector<PeriodicMotion> motions;
  for (std::size_t i = 0; i < points_.size(); i += step) {
    motions.push_back(points_[i].motion);
    if (motions.size() < static_cast<std::size_t>(signals::n_lanes) && i + step < points_.size())
      continue;
    for (const double share : balance_->neglected(motions)) largest = std::max(largest, share);
    motions.clear();
  }
  return largest;
}

bool ResponseCurve::begin(const double first_rad_s, const double direction) {
  const auto first = first_motion(*balance_, first_rad_s);
  if (!first) return false;
  const PeriodicMotion& motion = *first;
  const Linearised at = balance_->linearised(motion);
  Point& point = points_.emplace_back(
      Point{.motion = motion, .peak = at.peak, .inverse = at.by_coordinates.inverse()});
  point.direction = -direction * point.inverse * at.by_frequency;
  point.direction_rad_s = direction;
  return true;
}

void ResponseCurve::follow(const double first_rad_s, const double last_rad_s) {
  constexpr double longest = 0.5, shortest = 1e-7, usual_turn = 0.97, sharpest_turn = 0.8;
  constexpr std::size_t most_points = 3000;
  const double direction = last_rad_s < first_rad_s ? -1. : 1.;
  is_complete_ = false;
  if (!begin(first_rad_s, direction)) return;
  for (double length = 0.05; points_.size() < most_points && length > shortest;) {
    const Point& last = points_.back();
    if (direction * (last.motion.w_rad_s - last_rad_s) >= 0.) {
      is_complete_ = true;
      return;
    }
    const ArcScale scale(last.motion);
    const Eigen::VectorXd along = scale.scaled(last.direction, last.direction_rad_s).normalized();
    PeriodicMotion next = last.motion;
    next.earlier_peak = std::max(next.earlier_peak, last.peak);
    scale.move(next, length * along);
    const auto found = corrected(*balance_, scale, next, along);
    const double straight = found ? found->direction.dot(along) : 0.;
    if (straight < sharpest_turn) {
      length *= 0.5;
      continue;
    }
    Point& point = points_.emplace_back(found->point);
    PeriodicMotion unit{.y = Eigen::VectorXd::Zero(along.size() - 1), .w_rad_s = 0.};
    scale.move(unit, found->direction);
    point.direction = unit.y;
    point.direction_rad_s = unit.w_rad_s;
    if (found->n_iterations <= 3 && straight > usual_turn) length = std::min(longest, 1.5 * length);
    if (straight < 0.5 * (usual_turn + sharpest_turn)) length *= 0.7;
  }
}

std::vector<std::vector<PeriodicMotion>> ResponseCurve::at(
    const std::span<const double> w_rad_s) const {
  std::vector<std::size_t> line;
  std::vector<PeriodicMotion> motions;
  std::vector<const Eigen::MatrixXd*> inverse;
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const Segment segment(points_[i], points_[i + 1]);
    for (const auto& [j, t] : segment.crossings(w_rad_s)) {
      line.push_back(j);
      motions.push_back(segment.motion(t, w_rad_s[j]));
      inverse.push_back(&points_[t < 0.5 ? i : i + 1].inverse);
    }
  }
  constexpr int n_iterations = 3;
  constexpr auto n_lanes = static_cast<std::size_t>(signals::n_lanes);
  for (std::size_t first = 0; first < motions.size(); first += n_lanes) {
    const std::size_t n = std::min(n_lanes, motions.size() - first);
    balance_->correct(std::span(motions).subspan(first, n), std::span(inverse).subspan(first, n),
                      n_iterations);
  }
  std::vector<std::vector<PeriodicMotion>> out(w_rad_s.size());
  for (std::size_t i = 0; i < line.size(); ++i) out[line[i]].push_back(std::move(motions[i]));
  return out;
}

std::vector<double> ResponseCurve::folds_rad_s() const {
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const Segment segment(points_[i], points_[i + 1]);
    if (const auto t = segment.turn()) out.push_back(segment.frequency(*t));
  }
  return out;
}

}  // namespace vibrissa::diagnosis
