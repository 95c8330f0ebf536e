#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "separation/identification/identify.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

struct IdentifyResponseOptions {
  std::optional<std::size_t> order = std::nullopt;  // number of poles, even; nothing: selected
  std::size_t max_order = 20;                       // orders above 6 only while held-out lines gain
  bool direct_term = true;
};

/// A model of a frequency response, with its fit to held-out lines.
struct IdentifiedResponse {
  FittedBvrm fit;  // to all lines
  std::size_t order = 0;
  /// 100 (1 - |H - G| / |H - mean H|) over every third line in the weighted norm of the fit, with G
  /// fitted to the other lines.
  double held_out_fit_percent = 0.;
  /// The response was written with the convention exp(-j w t): its conjugate was fitted.
  bool conjugated = false;
  std::string order_words;  // when the order is the highest that was tried
};

/// Identifies the base vibration response model from a frequency response of the continuous
/// signals, with identify_frequency(). The weights come from the standard deviation or, when it is
/// unknown, from the coherence. The order is selected among the orders up to max_order that predict
/// the held-out lines clearly better than every lower order: the one with the smallest n ln(mean
/// |e|^2) + n_parameters ln n, with n real residuals; a fit that is not determined is no candidate.
/// A stable sensor cannot follow the conjugate of its response: when the conjugate leaves less than
/// half the error on the held-out lines (of orders up to 6), the response has the other sign
/// convention. Throws what identify_frequency() throws. Proven by
/// tests/separation/identification/identify_response_test.cc.
IdentifiedResponse identify_response(const signals::FrequencyResponse& response,
                                     const IdentifyResponseOptions& options = {});

/// The same response in the other sign convention.
signals::FrequencyResponse conjugate_of(signals::FrequencyResponse response);
/// Distance of the lines at a frequency [Hz].
double line_spacing_hz(const signals::FrequencyResponse& response, double at_hz);
/// Whether the peak of a mode is at least two lines wide at half power. Otherwise its lines are
/// those of the spectral window; the deviation of its frequency is then at least that of an equal
/// distribution over one line, unless the response is exact (exact_share).
bool is_resolved(const ModeEstimate& mode, const signals::FrequencyResponse& response);

}  // namespace vibrissa::separation
