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
  /// E|noise|^2 of the output at each line, as squared amplitude (a cos(w t) has a^2): from what
  /// the polynomials leave.
  std::vector<double> noise_variance;
};

/// Frequency response of an arbitrary record: about every line the response and the leakage (the
/// transient of the record's ends) are smooth, hence polynomials in frequency, fitted by least
/// squares to Y = G U + T in a window of lines (Pintelon & Schoukens, System Identification, 2nd
/// ed., chapter 7; Schoukens, Vandersteen, Barbe & Pintelon 2009). Near the ends of the band the
/// window is one-sided. At every line of the record without zero frequency and half the sampling
/// rate; NaN where the input does not determine the fit. The stated deviation holds for noise at
/// the output; input noise biases as in every H1 estimate. Throws UserError for channels of
/// unequal length, samples that are not finite, a rate that is not positive, a window without a
/// degree of freedom, or a record shorter than one window.
/// Proven by tests/signals/spectra/local_polynomial_test.cc.
LocalPolynomialResponse local_polynomial_response(std::span<const double> input,
                                                  std::span<const double> output,
                                                  double sampling_rate_hz,
                                                  const LocalPolynomialOptions& options = {});

}  // namespace vibrissa::signals
