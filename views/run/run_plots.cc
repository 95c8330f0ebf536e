#include "views/run/run_plots.h"

#include <algorithm>
#include <functional>

#include "signals/spectra/frequency_response.h"

namespace vibrissa::views {

namespace {

constexpr double milli = 1e-3;

std::vector<double> scaled(const std::span<const double> values, const double unit) {
  std::vector<double> result(values.begin(), values.end());
  for (double& value : result) value /= unit;
  return result;
}

std::vector<double> times(const signals::Record& record, const std::size_t first,
                          const std::size_t count) {
  std::vector<double> t;
  for (std::size_t i = first; i < first + count; ++i) t.push_back(record.time_s(i));
  return t;
}

report::Curve trace(const std::string& label, std::vector<double> x, std::vector<double> y,
                    const std::size_t colour) {
  report::Curve curve;
  curve.label = label;
  curve.x = std::move(x);
  curve.y = std::move(y);
  curve.colour = colour;
  return curve;
}

report::Panel channel_panel(const signals::Record& record, const std::string& channel,
                            const std::string& label, const double unit) {
  report::Panel panel;
  panel.x_label = "Time [s]";
  panel.y_label = label;
  panel.curves.push_back(trace("", times(record, 0, record.n_samples()),
                               scaled(record.channel(channel), unit), panel.curves.size()));
  return panel;
}

// Methods shown beside the true signal; references that are no practical method are left out.
bool shown(const SeparatedSignal& signal) {
  return signal.name != "nothing removed" && signal.name != "true response";
}

// A part of the measured moment: the true one and a method's estimate.
struct Share {
  std::string label;
  const std::vector<double>& truth_n_m;
  std::function<std::vector<double>(const SeparatedSignal&)> estimate;
};

Share wind_share(const sensor_case::RigRecords& records) {
  return {.label = "Wind moment [mN m]",
          .truth_n_m = records.true_wind_moment_n_m,
          .estimate = [](const SeparatedSignal& signal) { return signal.wind_moment_n_m; }};
}

Share vibration_share(const sensor_case::RigRecords& records) {
  return {.label = "Vibration moment [mN m]",
          .truth_n_m = records.true_vibration_moment_n_m,
          .estimate = [&records](const SeparatedSignal& signal) {
            const auto measured = records.both.channel(signals::channel::base_moment);
            std::vector<double> rest(measured.size());
            std::ranges::transform(measured, signal.wind_moment_n_m, rest.begin(), std::minus());
            return rest;
          }};
}

report::Panel separation_panel(const sensor_case::RigRecords& records, const Share& share,
                               const std::vector<SeparatedSignal>& signals, const std::size_t first,
                               const std::size_t count) {
  report::Panel panel;
  panel.x_label = "Time [s]";
  panel.y_label = share.label;
  const auto part = [&](const std::vector<double>& values) {
    return scaled(std::span(values).subspan(first, count), milli);
  };
  const auto t = times(records.both, first, count);
  std::size_t colour = 1;
  for (const auto& signal : signals) {
    if (shown(signal)) {
      panel.curves.push_back(trace(signal.name, t, part(share.estimate(signal)), colour++));
    }
  }
  panel.curves.push_back(trace("true", t, part(share.truth_n_m), 0));
  panel.curves.back().style = report::CurveStyle::dashed;
  return panel;
}

}  // namespace

report::Figure records_figure(const sensor_case::RigRecords& records) {
  report::Figure figure;
  figure.name = "records";
  figure.title = "Base moment under base vibration and wind";
  figure.caption = "Measured base acceleration, wind speed and base moment.";
  figure.panels = {
      channel_panel(records.both, signals::channel::base_acceleration,
                    "Base acceleration [m/s\u00b2]", 1.),
      channel_panel(records.both, signals::channel::wind_speed, "Wind speed [m/s]", 1.),
      channel_panel(records.both, signals::channel::base_moment, "Base moment [mN m]", milli)};
  return figure;
}

report::Figure separation_figure(const sensor_case::RigRecords& records,
                                 const std::vector<SeparatedSignal>& signals) {
  const std::size_t n = records.both.n_samples();
  const auto second = static_cast<std::size_t>(records.both.sampling_rate_hz());
  const std::size_t count = std::min(n, second);
  report::Figure figure;
  figure.name = "separation";
  figure.title = "Wind and vibration moment: true and separated";
  figure.caption =
      "Wind moment over the whole record; wind moment and vibration moment over one second from "
      "the middle of the record.";
  const std::size_t first = (n - count) / 2;
  figure.panels = {separation_panel(records, wind_share(records), signals, 0, n),
                   separation_panel(records, wind_share(records), signals, first, count),
                   separation_panel(records, vibration_share(records), signals, first, count)};
  figure.panels[0].title = "Whole record";
  figure.panels[1].title = "Wind moment, one second from the middle";
  figure.panels[2].title = "Vibration moment, the same second";
  return figure;
}

report::Figure spectra_figure(const sensor_case::RigRecords& records,
                              const std::vector<SeparatedSignal>& signals) {
  report::Panel panel;
  panel.x_label = "Frequency [Hz]";
  panel.y_label = "Power spectral density [(N m)\u00b2/Hz]";
  panel.log_x = panel.log_y = true;
  const double rate = records.both.sampling_rate_hz();
  signals::WelchOptions options;
  options.segment_samples =
      std::min<std::size_t>(options.segment_samples, records.both.n_samples() / 2);
  std::size_t colour = 1;
  const auto add = [&](const std::string& label, const std::span<const double> x,
                       const std::size_t use_colour) {
    auto spectrum = signals::welch_spectrum(x, rate, options);
    panel.curves.push_back(
        trace(label, std::move(spectrum.frequency_hz), std::move(spectrum.density), use_colour));
  };
  for (const auto& signal : signals) {
    if (shown(signal)) add(signal.name, signal.wind_moment_n_m, colour++);
  }
  add("measured, with vibration", records.both.channel(signals::channel::base_moment), colour);
  add("true wind moment", records.true_wind_moment_n_m, 0);
  panel.curves.back().style = report::CurveStyle::dashed;
  report::Figure figure;
  figure.name = "spectra";
  figure.title = "Power spectral densities of the measured, true and separated moments";
  figure.caption = "One-sided densities by Welch's method.";
  figure.panels = {panel};
  return figure;
}

}  // namespace vibrissa::views
