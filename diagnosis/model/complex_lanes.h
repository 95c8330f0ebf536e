#pragma once

#include <complex>

#include "signals/base/lanes.h"

namespace vibrissa::diagnosis {

/// Complex numbers side by side in lanes, with the operators that transfer functions need. Values
/// are finite: no repair of infinities. Proven by tests/diagnosis/model/complex_lanes_test.cc.
struct ComplexLanes {
  signals::Lanes re = signals::Lanes::Zero(), im = signals::Lanes::Zero();

  ComplexLanes() = default;
  ComplexLanes(const double value) : re(signals::Lanes::Constant(value)) {}
  ComplexLanes(const signals::Lanes& real, const signals::Lanes& imaginary)
      : re(real), im(imaginary) {}

  std::complex<double> operator[](const Eigen::Index lane) const { return {re(lane), im(lane)}; }
  void set(const Eigen::Index lane, const std::complex<double> value) {
    re(lane) = value.real();
    im(lane) = value.imag();
  }

  friend ComplexLanes operator+(const ComplexLanes& a, const ComplexLanes& b) {
    return {a.re + b.re, a.im + b.im};
  }
  friend ComplexLanes operator+(const double a, const ComplexLanes& b) { return {a + b.re, b.im}; }
  friend ComplexLanes operator+(const ComplexLanes& a, const double b) { return b + a; }
  friend ComplexLanes operator-(const ComplexLanes& a, const ComplexLanes& b) {
    return {a.re - b.re, a.im - b.im};
  }
  friend ComplexLanes operator*(const ComplexLanes& a, const ComplexLanes& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend ComplexLanes operator*(const double a, const ComplexLanes& b) {
    return {a * b.re, a * b.im};
  }
  friend ComplexLanes operator*(const ComplexLanes& a, const double b) { return b * a; }
  friend ComplexLanes operator/(const ComplexLanes& a, const ComplexLanes& b) {
    const signals::Lanes per_norm = (b.re.square() + b.im.square()).inverse();
    return {(a.re * b.re + a.im * b.im) * per_norm, (a.im * b.re - a.re * b.im) * per_norm};
  }
  friend ComplexLanes operator/(const ComplexLanes& a, const double b) { return (1. / b) * a; }
  friend ComplexLanes operator/(const double a, const ComplexLanes& b) {
    const signals::Lanes factor = a * (b.re.square() + b.im.square()).inverse();
    return {b.re * factor, -b.im * factor};
  }
  ComplexLanes& operator+=(const ComplexLanes& other) { return *this = *this + other; }
  ComplexLanes& operator*=(const ComplexLanes& other) { return *this = *this * other; }
};

}  // namespace vibrissa::diagnosis
