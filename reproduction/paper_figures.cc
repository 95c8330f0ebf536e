#include "reproduction/paper_figures.h"

#include <cmath>

#include "report/figures/table.h"
#include "reproduction/paper_rig.h"
#include "views/records/bode_data.h"
#include "views/run/run_plots.h"

namespace vibrissa::reproduction {

namespace {

using paper::g_m_s2;
constexpr double mn_mm = 1e-6;  // N m

std::string text(const double value) {
  return report::Cell(value).rounded(3);
}

std::vector<double> logarithmic(const double low, const double high, const std::size_t n) {
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / double(n - 1)));
  }
  return values;
}

report::Curve step_curve(const signals::ReducedModel& beam, const double amplitude_g) {
  constexpr double rate_hz = 20000.;
  const std::vector<double> step(static_cast<std::size_t>(0.3 * rate_hz), amplitude_g * g_m_s2);
  const auto moment = signals::simulate(beam, {rate_hz, step.size(), step}).base_moment;
  report::Curve curve;
  curve.label = text(amplitude_g) + " g";
  for (std::size_t i = 0; i < moment.size(); i += 4) {
    curve.x.push_back(static_cast<double>(i) / rate_hz);
    curve.y.push_back(moment[i] / mn_mm);
  }
  return curve;
}

// Absolute static moment per base acceleration about the moment axis.
double static_gain_kg_m(const signals::ReducedModel& model) {
  const std::vector<double> zero_hz = {0.};
  return std::abs(signals::base_response(model, zero_hz)[0]);
}

report::Panel logarithmic_panel(const std::string& x_label) {
  report::Panel panel;
  panel.x_label = x_label;
  panel.y_label = "Moment [mN mm]";
  panel.log_x = panel.log_y = true;
  return panel;
}

}  // namespace

report::Figure step_responses(const signals::Beam& wire) {
  const auto beam = signals::beam_model(wire, 8);
  report::Figure figure;
  figure.name = "figure_07_step_responses";
  figure.title = "Analytical beam: base moment after a step of base acceleration";
  figure.caption =
      "Free wire of the whisker with a rigid clamp; eight modes and the static correction. The "
      "moment is proportional to the amplitude.";
  figure.panels.resize(1);
  figure.panels[0].x_label = "Time [s]";
  figure.panels[0].y_label = "Base moment [mN mm]";
  for (const double amplitude_g : {0.1, 0.5, 1., 1.5}) {
    figure.panels[0].curves.push_back(step_curve(beam, amplitude_g));
  }
  return figure;
}

report::Figure steady_responses(const PaperSensors& sensors) {
  report::Panel wind = logarithmic_panel("Wind speed [m/s]");
  report::Panel base = logarithmic_panel("Base acceleration [m/s\u00b2]");
  for (const auto* model : {&sensors.flow, &sensors.whisker}) {
    report::Curve by_wind{.label = model->name}, by_base{.label = model->name};
    for (const double u : logarithmic(0.1, 10., 60)) {
      by_wind.x.push_back(u);
      by_wind.y.push_back(std::abs(signals::steady_wind_moment(*model, u)) / mn_mm);
    }
    for (const double a : logarithmic(0.01 * g_m_s2, 1.5 * g_m_s2, 20)) {
      by_base.x.push_back(a);
      by_base.y.push_back(static_gain_kg_m(*model) * a / mn_mm);
    }
    wind.curves.push_back(std::move(by_wind));
    base.curves.push_back(std::move(by_base));
  }
  report::Figure figure;
  figure.name = "figure_08_steady_responses";
  figure.title = "Steady base moment: nonlinear in wind, linear in acceleration";
  figure.caption =
      "Absolute values of the moments. Linear model with quasi-steady drag, Cd(Re) of wire and "
      "blades; vibrissa static computes the whole solid at finite strain.";
  figure.panels = {wind, base};
  return figure;
}

report::Figure base_responses(const PaperSensors& sensors) {
  std::vector<views::BodeCurve> curves;
  for (const auto* model : {&sensors.flow, &sensors.whisker, &sensors.built}) {
    std::vector<double> resonances;
    for (const auto& mode : model->modes) resonances.push_back(mode.frequency_hz);
    curves.push_back(views::bode_curve(*model, views::bode_frequencies(1., 250., resonances)));
    curves.back().label = model->name;
  }
  report::Figure figure = views::bode_figure(curves);
  figure.name = "figure_09_bode";
  figure.title = "Frequency response from base acceleration to base moment";
  return figure;
}

report::Figure estimates(const PaperTrial& trial, const std::string& name,
                         const std::string& title) {
  report::Figure figure = views::separation_figure(trial.records, trial.separated);
  const report::Figure recorded = views::records_figure(trial.records);
  figure.panels.insert(figure.panels.begin(), recorded.panels.back());
  figure.panels.front().title = "Measured";
  figure.name = name;
  figure.title = title;
  return figure;
}

report::Figure experiment_spectra(const PaperTrial& trial) {
  report::Figure figure = views::spectra_figure(trial.records, trial.separated);
  figure.name = "figure_12_spectra";
  figure.title = "Simulated experiment: power spectral densities";
  figure.caption =
      "Base motion at 12, 15, 19, 23, 26 and 29 Hz; wind mostly near 1.6 Hz. One-sided densities "
      "by Welch's method.";
  figure.panels[0].x_range = report::Range{0.5, 100.};
  return figure;
}

double wind_exponent(const signals::ReducedModel& model, const double low_m_s,
                     const double high_m_s) {
  return std::log(signals::steady_wind_moment(model, high_m_s) /
                  signals::steady_wind_moment(model, low_m_s)) /
         std::log(high_m_s / low_m_s);
}

}  // namespace vibrissa::reproduction
