#include "views/records/ring_down_plots.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "signals/base/student.h"

namespace vibrissa::views {

namespace {

using separation::DecayPoint;
using separation::Estimate;
using separation::RingDown;

constexpr std::size_t law_colour = 1, measured_colour = 0;

report::Panel decay_panel(const RingDown& found, std::span<const double> moment, double rate_hz) {
  report::Panel panel{
      .title = "Free decay", .x_label = "Time [s]", .y_label = "Moment [" + found.unit + "]"};
  report::Curve measured{.label = "measured", .y = {moment.begin(), moment.end()}};
  for (std::size_t i = 0; i < moment.size(); ++i)
    measured.x.push_back(static_cast<double>(i) / rate_hz);
  measured.colour = measured_colour;
  panel.curves.push_back(std::move(measured));
  for (const separation::Envelope& envelope : found.envelopes) {
    const bool first = panel.curves.size() == 1;
    panel.curves.push_back({.label = first ? "envelope of the law" : "",
                            .x = envelope.upper_s,
                            .y = envelope.upper_n_m,
                            .colour = law_colour});
    panel.curves.push_back({.x = envelope.lower_s, .y = envelope.lower_n_m, .colour = law_colour});
  }
  return panel;
}

double half_interval(const Estimate& estimate) {
  return signals::normal_quantile_975 * estimate.standard_deviation;
}

/// Points with a bar from end to end of each interval.
void add_measured(const std::vector<DecayPoint>& points, Estimate DecayPoint::*value,
                  report::Panel& panel) {
  constexpr double gap = std::numeric_limits<double>::quiet_NaN();
  report::Curve point{.label = "without a law", .style = report::CurveStyle::points}, bar;
  point.colour = bar.colour = measured_colour;
  for (const DecayPoint& at : points) {
    const Estimate& estimate = at.*value;
    point.x.push_back(at.amplitude_n_m);
    point.y.push_back(estimate.value);
    const double half = half_interval(estimate);
    bar.x.insert(bar.x.end(), {at.amplitude_n_m, at.amplitude_n_m, gap});
    bar.y.insert(bar.y.end(), {estimate.value - half, estimate.value + half, gap});
  }
  if (points.empty()) return;
  panel.curves.push_back(std::move(bar));
  panel.curves.push_back(std::move(point));
}

void add_law(const std::vector<DecayPoint>& points, Estimate DecayPoint::*value,
             report::Panel& panel) {
  report::Curve band{.style = report::CurveStyle::band}, line{.label = "law"};
  band.colour = line.colour = law_colour;
  for (const DecayPoint& at : points) {
    const Estimate& estimate = at.*value;
    band.x.push_back(at.amplitude_n_m);
    band.y_low.push_back(estimate.value - half_interval(estimate));
    band.y_high.push_back(estimate.value + half_interval(estimate));
    line.y.push_back(estimate.value);
  }
  line.x = band.x;
  panel.curves.push_back(std::move(band));
  panel.curves.push_back(std::move(line));
}

report::Panel against_amplitude(const RingDown& found, Estimate DecayPoint::*value,
                                const std::string& label) {
  report::Panel panel{
      .x_label = "Amplitude of the moment [" + found.unit + "]", .y_label = label, .log_x = true};
  // Wider than the amplitudes, so that no bar lies on the frame.
  constexpr double margin = 1.1;
  double low = found.fitted.back().amplitude_n_m, high = found.fitted.front().amplitude_n_m;
  for (const DecayPoint& point : found.measured) {
    low = std::min(low, point.amplitude_n_m);
    high = std::max(high, point.amplitude_n_m);
  }
  panel.x_range = report::Range{low / margin, high * margin};
  add_law(found.fitted, value, panel);
  add_measured(found.measured, value, panel);
  return panel;
}

}  // namespace

report::Figure ring_down_figure(const RingDown& found, std::span<const double> moment,
                                const double sampling_rate_hz) {
  return {.name = "ring_down",
          .title = "Free decay: frequency and damping against amplitude",
          .caption =
              "Band and bars: 95 % intervals. Law: one law fitted to all samples. Without a "
              "law: damped sines, a few periods each.",
          .panels = {decay_panel(found, moment, sampling_rate_hz),
                     against_amplitude(found, &DecayPoint::frequency_hz, "Frequency [Hz]"),
                     against_amplitude(found, &DecayPoint::damping_ratio, "Damping ratio")}};
}

}  // namespace vibrissa::views
