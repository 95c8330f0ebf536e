#pragma once

#include <cstddef>
#include <optional>

#include "separation/identification/identify.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

struct IdentifyResponseOptions {
  std::optional<std::size_t> order = std::nullopt;  // number of poles, even; nothing: chosen
  std::size_t max_order = 6;
  bool direct_term = true;
};

/// A model of a frequency response, and how well the lines that it did not see fit.
struct IdentifiedResponse {
  FittedBvrm fit;  // to all lines
  std::size_t order = 0;
  /// 100 (1 - |H - G| / |H - mean H|) over every third line in the weighted norm of the fit, G
  /// fitted to the others.
  double held_out_fit_percent = 0.;
};

/// The base-vibration response model of a response of the continuous signals, by
/// identify_frequency(), lines weighted by their standard deviation or, where that is not known, by
/// the one that goes with their coherence. Of the orders up to max_order that predict the held-out
/// lines clearly better than every lower one, that with the least n ln(mean |e|^2) + n_parameters
/// ln n, n real residuals. Throws what identify_frequency() throws. Proven by
/// tests/separation/identification/identify_response_test.cc.
IdentifiedResponse identify_response(const signals::FrequencyResponse& response,
                                     const IdentifyResponseOptions& options = {});

}  // namespace vibrissa::separation
