#include "views/records/bode_data.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vibrissa::views {

std::vector<double> bode_frequencies(const double low_hz, const double high_hz,
                                     const std::vector<double>& resonance_hz) {
  constexpr int n_even = 400, n_near = 60;
  std::vector<double> f;
  for (int i = 0; i <= n_even; ++i) {
    f.push_back(low_hz * std::pow(high_hz / low_hz, static_cast<double>(i) / n_even));
  }
  for (const double resonance : resonance_hz) {
    for (int i = -n_near; i <= n_near; ++i) {
      const double near = resonance * (1. + 0.2 * std::pow(static_cast<double>(i) / n_near, 3));
      if (near > low_hz && near < high_hz) f.push_back(near);
    }
  }
  std::sort(f.begin(), f.end());
  // Modes come in pairs that differ only by rounding.
  const auto alike = [](const double a, const double b) { return b - a < 1e-9 * b; };
  f.erase(std::unique(f.begin(), f.end(), alike), f.end());
  return f;
}

BodeCurve bode_curve(const signals::ReducedModel& model, const std::vector<double>& frequency_hz) {
  return {model.name,
          report::CurveStyle::line,
          {frequency_hz, signals::base_response(model, frequency_hz), {}, {}}};
}

BodeCurve bode_curve(const separation::Bvrm& model, const std::vector<double>& frequency_hz) {
  return {"identified model",
          report::CurveStyle::dashed,
          {frequency_hz, separation::response(model, frequency_hz), {}, {}}};
}

namespace {

// In (-360, 0] degrees: the phase starts at -180 degrees at low frequency, because the moment
// opposes the acceleration, and falls with a lag.
double phase_deg(const std::complex<double> value) {
  const double degrees = std::arg(value) * 180. / std::numbers::pi;
  return degrees > 1e-6 ? degrees - 360. : degrees;
}

report::Curve curve_of(const BodeCurve& data, std::vector<double> y, const std::size_t colour) {
  report::Curve curve;
  curve.label = data.label;
  curve.style = data.style;
  curve.x = data.response.frequency_hz;
  curve.y = std::move(y);
  curve.colour = colour;
  return curve;
}

}  // namespace

report::Figure bode_figure(const std::vector<BodeCurve>& curves) {
  report::Panel magnitude, phase, coherence;
  magnitude.x_label = phase.x_label = coherence.x_label = "Frequency [Hz]";
  magnitude.log_x = phase.log_x = coherence.log_x = magnitude.log_y = true;
  magnitude.y_label = "|M / a| [N m s\u00b2/m]";
  phase.y_label = "Phase [\u00b0]";
  coherence.y_label = "Coherence [1]";
  coherence.y_range = report::Range{0., 1.05};
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto& data = curves[i];
    std::vector<double> size, angle;
    for (const auto& value : data.response.value) {
      size.push_back(std::abs(value));
      angle.push_back(phase_deg(value));
    }
    magnitude.curves.push_back(curve_of(data, size, i));
    phase.curves.push_back(curve_of(data, angle, i));
    phase.curves.back().label.clear();
    if (!data.response.coherence.empty()) {
      coherence.curves.push_back(curve_of(data, data.response.coherence, i));
      coherence.curves.back().label.clear();
    }
  }
  report::Figure figure;
  figure.name = "bode";
  figure.title = "Frequency response from base acceleration to base moment";
  figure.caption =
      "Magnitude, phase and (for records) coherence, with the time convention exp(+j ω t).";
  figure.panels = {magnitude, phase};
  if (!coherence.curves.empty()) figure.panels.push_back(coherence);
  return figure;
}

}  // namespace vibrissa::views
