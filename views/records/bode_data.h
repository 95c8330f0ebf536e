#pragma once

#include <string>
#include <vector>

#include "report/figures/figure.h"
#include "separation/model/rational_model.h"
#include "signals/model/reduced_model.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::views {

/// Frequencies of a smooth Bode diagram: logarithmic, with more points about each resonance.
/// Resonances that differ only by rounding count once. Proven by tests/apps/bode_test.cc.
std::vector<double> bode_frequencies(double low_hz, double high_hz,
                                     const std::vector<double>& resonance_hz);

/// One curve of a Bode diagram: response from base acceleration to base moment [N m s^2/m].
struct BodeCurve {
  std::string label;
  report::CurveStyle style = report::CurveStyle::line;
  signals::FrequencyResponse response;
};

BodeCurve bode_curve(const signals::ReducedModel& model, const std::vector<double>& frequency_hz);
BodeCurve bode_curve(const separation::Bvrm& model, const std::vector<double>& frequency_hz);

/// Magnitude and phase (-180 degrees at low frequency), and coherence where it is known.
report::Figure bode_figure(const std::vector<BodeCurve>& curves);

}  // namespace vibrissa::views
