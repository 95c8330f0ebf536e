#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "signals/spectra/frequency_response.h"

namespace vibrissa::signals {

struct LocalPolynomialOptions {
  std::size_t order = 2;  // of the polynomials of response and transient
  std::size_t half_width =
      0;  // lines on each side; 0: the narrowest with 4 degrees of freedom left
};

struct LocalPolynomialResponse {
  FrequencyResponse response;
  /// E|noise|^2 of the output at each line, as squared amplitude (a cos(w t) has a^2): from the
  /// residual of the polynomials.
  std::vector<double> noise_variance;
};

/// Frequency response of an arbitrary record. Near each line the response G and the leakage T (the
/// transient of the ends of the record) are smooth functions of frequency; polynomials are fitted
/// to them by least squares, Y = G U + T in a window of lines (Pintelon & Schoukens, System
/// Identification, 2nd ed., chapter 7; Schoukens, Vandersteen, Barbe & Pintelon 2009). Near the
/// ends of the band the window is one-sided. The result has every line of the record except zero
/// frequency and half the sampling rate; NaN where the input does not determine the fit. The
/// deviation is valid for output noise; input noise causes a bias, as in every H1 estimate. Throws
/// UserError for channels of unequal length, samples that are not finite, a rate that is not
/// positive, a window without a degree of freedom, or a record shorter than one window. Proven by
/// tests/signals/spectra/local_polynomial_test.cc.
LocalPolynomialResponse local_polynomial_response(std::span<const double> input,
                                                  std::span<const double> output,
                                                  double sampling_rate_hz,
                                                  const LocalPolynomialOptions& options = {});

}  // namespace vibrissa::signals
