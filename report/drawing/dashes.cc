#include "report/drawing/dashes.h"

#include <cassert>
#include <cmath>
#include <limits>

namespace vibrissa::report {
namespace {

/// Follows a line and keeps the parts that are drawn.
class Pen {
 public:
  Pen(const double on, const double off) : on_(on), off_(off) { assert(on > 0. && off > 0.); }

  void start(const double x, const double y) {
    lift(x_);
    down_ = true;
    left_ = on_;
    move(x, y);
  }

  void go(const double x, const double y) {
    double length = std::hypot(x - x_, y - y_);
    while (length > left_) {
      const double part = left_ / length;
      length -= left_;
      move(x_ + part * (x - x_), y_ + part * (y - y_));
      down_ = !down_;
      left_ = down_ ? on_ : off_;
      down_ ? keep() : lift(x_);
    }
    left_ -= length;
    move(x, y);
  }

  Polyline line() const { return line_; }

 private:
  void move(const double x, const double y) {
    x_ = x;
    y_ = y;
    if (down_) keep();
  }
  void keep() {
    line_.x.push_back(x_);
    line_.y.push_back(y_);
  }
  void lift(const double x) {
    if (line_.x.empty()) return;
    line_.x.push_back(x);
    line_.y.push_back(std::numeric_limits<double>::quiet_NaN());
  }

  double on_, off_, left_ = 0., x_ = 0., y_ = 0.;
  bool down_ = false;
  Polyline line_;
};

}  // namespace

Polyline dashes(const Polyline& line, const double on, const double off) {
  Pen pen(on, off);
  bool drawing = false;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    const bool finite = std::isfinite(line.x[i]) && std::isfinite(line.y[i]);
    if (finite) drawing ? pen.go(line.x[i], line.y[i]) : pen.start(line.x[i], line.y[i]);
    drawing = finite;
  }
  return pen.line();
}

}  // namespace vibrissa::report
