#pragma once

#include <complex>
#include <vector>

#include "separation/model/fitted_bvrm.h"

namespace vibrissa::separation {

/// A point of the s-plane [rad/s] with the standard deviations of its parts. Only the point above
/// the real axis of a complex pair is given.
struct PlaneEstimate {
  std::complex<double> value;
  double real_deviation = 0., imaginary_deviation = 0.;
};

struct PolesAndZeros {
  std::vector<PlaneEstimate> poles, zeros;  // by ascending magnitude
};

/// Poles and zeros of a fitted model (without its delay) with deviations by linear propagation of
/// its covariance: dz/dp = -(dG/dp) / (dG/ds) at a zero z. Zeros are the roots of the numerator
/// over the common denominator; zeros at infinity (without direct term) are omitted. NaN deviations
/// where the covariance is unknown; an infinite one at a double pole or zero. Proven by
/// tests/separation/model/poles_zeros_test.cc.
PolesAndZeros poles_and_zeros(const FittedBvrm& fit);

}  // namespace vibrissa::separation
