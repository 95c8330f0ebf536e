#include "views/records/diagnosis_plots.h"

#include <algorithm>
#include <cmath>

#include "report/figures/table.h"

namespace vibrissa::views {
namespace {

const std::string over_noise = "Error power / noise power";

report::Curve excess_curve(const std::string& label, const std::vector<diagnosis::BandGap>& bands) {
  report::Curve curve{.label = label};
  for (const diagnosis::BandGap& band : bands) {
    curve.x.push_back(std::sqrt(band.low_hz * band.high_hz));
    curve.y.push_back(band.excess);
  }
  return curve;
}

report::Panel panel_over_frequency(const std::string& title) {
  return {.title = title,
          .x_label = "Frequency [Hz]",
          .y_label = over_noise,
          .log_x = true,
          .log_y = true};
}

report::Panel gap_by_kind(const std::vector<diagnosis::ChannelGap>& map) {
  report::Panel panel = panel_over_frequency("Error of the nominal simulation by kind of record");
  for (const diagnosis::ChannelGap& channel : map)
    // Records with base motion and wind.
    panel.curves.push_back(excess_curve(
        channel.channel == "product" ? "base and wind" : channel.channel, channel.bands));
  return panel;
}

report::Panel gap_by_level(const std::vector<diagnosis::LevelGap>& levels) {
  report::Panel panel = panel_over_frequency("Error under base motion by level (rms)");
  for (const diagnosis::LevelGap& level : levels)
    panel.curves.push_back(
        excess_curve(report::Cell(level.level_m_s2).rounded(3) + " m/s²", level.bands));
  return panel;
}

report::Panel gap_in_time(const std::vector<diagnosis::GapInTime>& records) {
  constexpr std::size_t most_curves = 8;  // more curves cannot be distinguished
  report::Panel panel{.title = "Error along the records",
                      .x_label = "Time [s]",
                      .y_label = over_noise,
                      .log_y = true};
  for (std::size_t i = 0; i < std::min(records.size(), most_curves); ++i)
    panel.curves.push_back(
        {.label = records[i].record, .x = records[i].time_s, .y = records[i].excess});
  return panel;
}

report::Figure gap_map(const diagnosis::Location& location) {
  report::Figure figure{.name = "gap_map",
                        .title = "Gap map",
                        .caption =
                            "Power of the nominal model's error divided by the noise power, in "
                            "third-octave bands by kind of record and by level of the base motion "
                            "(rms), and along each record. A value of 1 means noise alone.",
                        .panels = {gap_by_kind(location.map)}};
  if (!location.by_level.empty()) figure.panels.push_back(gap_by_level(location.by_level));
  if (!location.in_time.empty()) figure.panels.push_back(gap_in_time(location.in_time));
  return figure;
}

report::Figure response_figure(const diagnosis::Diagnosis& diagnosis) {
  const diagnosis::ResponseComparison& response = diagnosis.response;
  std::vector<double> low, high;
  for (std::size_t i = 0; i < response.measured.size(); ++i) {
    low.push_back(
        std::max(response.measured[i] - 2. * response.deviation[i], 0.01 * response.measured[i]));
    high.push_back(response.measured[i] + 2. * response.deviation[i]);
  }
  report::Panel panel{.title = "Base moment per base acceleration, " + response.record,
                      .x_label = "Frequency [Hz]",
                      .y_label = "|M / a| [N m s²/m]",
                      .log_x = true,
                      .log_y = true};
  panel.curves.push_back({.label = "measured, ± 2 standard deviations of noise",
                          .style = report::CurveStyle::band,
                          .x = response.frequency_hz,
                          .y_low = low,
                          .y_high = high});
  panel.curves.push_back(
      {.label = "simulation", .x = response.frequency_hz, .y = response.nominal});
  panel.curves.push_back({.label = "with " + diagnosis.verdict,
                          .style = report::CurveStyle::dashed,
                          .x = response.frequency_hz,
                          .y = response.updated});
  return {.name = "response",
          .title = "Response before and after correction",
          .caption = "Values at the excited lines.",
          .panels = {panel}};
}

std::string unit_of(const diagnosis::Diagnosis& diagnosis) {
  return diagnosis.levels.front().readout == signals::Readout::moment ? "N m" : "rad or m";
}

std::string level_name(const diagnosis::LevelComparison& level) {
  return report::Cell(level.level_m_s2).rounded(3) + " m/s²" +
         (level.held_out ? ", not used for the fit" : "");
}

std::vector<double> per_level(const std::vector<double>& values,
                              const diagnosis::LevelComparison& level) {
  std::vector<double> out = values;
  for (double& value : out) value /= level.level_m_s2;
  return out;
}

/// Measured and corrected responses of all sweeps in one direction; a colour for each level.
report::Panel level_panel(const diagnosis::Diagnosis& diagnosis,
                          const signals::SweepDirection direction) {
  report::Panel panel{.title = "Sweep " + signals::to_string(direction) +
                               ": measured (points), with " + diagnosis.verdict + " (lines)",
                      .x_label = "Frequency [Hz]",
                      .y_label = "Response / base acceleration [" + unit_of(diagnosis) + " s²/m]",
                      .log_y = true};
  const diagnosis::LevelComparison* last = nullptr;
  std::size_t colour = 0;
  for (const diagnosis::LevelComparison& level : diagnosis.levels) {
    if (level.direction != direction) continue;
    last = &level;
    panel.curves.push_back({.label = level_name(level),
                            .style = report::CurveStyle::points,
                            .x = level.frequency_hz,
                            .y = per_level(level.measured, level),
                            .colour = colour});
    panel.curves.push_back(
        {.x = level.frequency_hz, .y = per_level(level.updated, level), .colour = colour++});
  }
  if (last != nullptr)
    panel.curves.push_back({.label = "simulation, " + level_name(*last),
                            .style = report::CurveStyle::dashed,
                            .x = last->frequency_hz,
                            .y = per_level(last->simulated, *last),
                            .colour = colour});
  return panel;
}

/// Frequency of the peak over its amplitude.
report::Panel backbone_panel(const diagnosis::Diagnosis& diagnosis) {
  report::Panel panel{.title = "Frequency of the peak over its amplitude",
                      .x_label = "Amplitude of the response [" + unit_of(diagnosis) + "]",
                      .y_label = "Frequency [Hz]"};
  std::size_t colour = 0;
  for (const auto direction : {signals::SweepDirection::up, signals::SweepDirection::down}) {
    const std::string sweep = ", sweep " + signals::to_string(direction);
    report::Curve measured{
        .label = "measured" + sweep, .style = report::CurveStyle::points, .colour = colour},
        updated{.label = "with " + diagnosis.verdict + sweep, .colour = colour++};
    for (const diagnosis::LevelComparison& level : diagnosis.levels) {
      if (level.direction != direction) continue;
      measured.x.push_back(level.measured_peak.amplitude);
      measured.y.push_back(level.measured_peak.frequency_hz);
      updated.x.push_back(level.updated_peak.amplitude);
      updated.y.push_back(level.updated_peak.frequency_hz);
    }
    if (measured.x.empty()) continue;
    panel.curves.push_back(std::move(measured));
    panel.curves.push_back(std::move(updated));
  }
  return panel;
}

report::Figure levels_figure(const diagnosis::Diagnosis& diagnosis) {
  report::Figure figure{
      .name = "response",
      .title = "Responses before and after correction",
      .caption =
          "Amplitudes at the measured lines. Where several states are stable, the corrected sweep "
          "jumps at the line where the measured one does, as far as its branch exists there."};
  for (const auto direction : {signals::SweepDirection::up, signals::SweepDirection::down})
    if (report::Panel panel = level_panel(diagnosis, direction); !panel.curves.empty())
      figure.panels.push_back(std::move(panel));
  figure.panels.push_back(backbone_panel(diagnosis));
  return figure;
}

/// The first n samples.
report::Panel trace_panel(const diagnosis::Diagnosis& diagnosis, const std::size_t n) {
  const diagnosis::TraceComparison& trace = diagnosis.trace;
  const auto part = [n](const std::vector<double>& x, double scale) {
    std::vector<double> out(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n));
    for (double& value : out) value *= scale;
    return out;
  };
  report::Panel panel{.title = "Held-out record " + trace.record,
                      .x_label = "Time [s]",
                      .y_label = "Base moment [µN m]"};
  panel.curves.push_back(
      {.label = "measured", .x = part(trace.time_s, 1.), .y = part(trace.measured, 1e6)});
  panel.curves.push_back(
      {.label = "simulation", .x = part(trace.time_s, 1.), .y = part(trace.nominal, 1e6)});
  panel.curves.push_back({.label = "with " + diagnosis.verdict,
                          .style = report::CurveStyle::dashed,
                          .x = part(trace.time_s, 1.),
                          .y = part(trace.updated, 1e6)});
  return panel;
}

report::Figure trace_figure(const diagnosis::Diagnosis& diagnosis) {
  const std::vector<double>& time_s = diagnosis.trace.time_s;
  // One second shows the oscillation; the CSV file holds the same samples.
  std::size_t n = 0;
  while (n < time_s.size() && time_s[n] < time_s.front() + 1.) ++n;
  return {.name = "held_out_trace",
          .title = "Held-out record before and after correction",
          .caption = "Free simulation of a record that was not used for the fit.",
          .panels = {trace_panel(diagnosis, n)}};
}

report::Figure ranking_figure(const std::vector<diagnosis::RankedAnswer>& ranking) {
  report::Panel panel{.title = "Probability of each answer",
                      .x_label = "Probability [1]",
                      .y_label = "Answer",
                      .x_range = report::Range{0., 1.}};
  report::Curve heads{.style = report::CurveStyle::points, .colour = 0};
  for (auto answer = ranking.rbegin(); answer != ranking.rend(); ++answer) {
    panel.y_names.push_back(answer->name);
    const double row = static_cast<double>(panel.y_names.size());
    heads.x.push_back(answer->probability);
    heads.y.push_back(row);
    panel.curves.push_back({.x = {0., answer->probability}, .y = {row, row}, .colour = 0});
  }
  panel.curves.push_back(std::move(heads));
  return {.name = "ranking",
          .title = "Answers",
          .caption = "Posterior probability of each answer, given these records.",
          .panels = {panel}};
}

report::Panel residual_panel(const std::string& quantity, const diagnosis::ResidualCurve& curve) {
  std::vector<double> low, high;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    low.push_back(curve.mean[i] - curve.deviation[i]);
    high.push_back(curve.mean[i] + curve.deviation[i]);
  }
  report::Panel panel{.title = "Residual moment over the " + quantity,
                      .x_label = "Joint " + quantity + " / its peak [1]",
                      .y_label = "Moment / peak moment [1]"};
  panel.curves.push_back({.label = "± 1 standard deviation",
                          .style = report::CurveStyle::band,
                          .x = curve.x,
                          .y_low = low,
                          .y_high = high});
  panel.curves.push_back({.label = "mean", .x = curve.x, .y = curve.mean});
  return panel;
}

report::Figure unknown_figure(const diagnosis::UnknownCause& unknown) {
  return {.name = "unknown_part",
          .title = "What is not explained, as a moment of the joint",
          .caption =
              "The moment that the joint would need in addition so that the simulation gives "
              "the measured moment; fit records, near the first mode.",
          .panels = {residual_panel("angle", unknown.residual.over_angle),
                     residual_panel("rate", unknown.residual.over_rate)}};
}

}  // namespace

std::vector<report::Figure> diagnosis_plots(const diagnosis::Diagnosis& diagnosis) {
  std::vector<report::Figure> figures;
  if (!diagnosis.location.map.empty()) figures.push_back(gap_map(diagnosis.location));
  if (!diagnosis.ranking.empty()) figures.push_back(ranking_figure(diagnosis.ranking));
  if (diagnosis.unknown_cause && !diagnosis.unknown_cause->residual.over_angle.x.empty())
    figures.push_back(unknown_figure(*diagnosis.unknown_cause));
  if (!diagnosis.levels.empty())
    figures.push_back(levels_figure(diagnosis));
  else if (!diagnosis.response.frequency_hz.empty())
    figures.push_back(response_figure(diagnosis));
  if (!diagnosis.trace.time_s.empty()) figures.push_back(trace_figure(diagnosis));
  return figures;
}

report::Figure held_out_record_figure(const diagnosis::Diagnosis& diagnosis) {
  report::Figure figure = trace_figure(diagnosis);
  report::Panel whole = trace_panel(diagnosis, diagnosis.trace.time_s.size());
  whole.title += ", whole record";
  figure.panels.front().title = "The first second";
  figure.panels.insert(figure.panels.begin(), std::move(whole));
  figure.name = "held_out_record";
  return figure;
}

report::Table level_table(const std::vector<diagnosis::LevelComparison>& levels) {
  report::Table table({{"level", "m/s²", 3},
                       {"sweep", ""},
                       {"used for the fit", ""},
                       {"measured peak", "Hz", 5},
                       {"simulated", "Hz", 5},
                       {"with correction", "Hz", 5},
                       {"correction - measured", "%", 2},
                       {"its branch ends", "Hz", 5},
                       {"measured amplitude", "", 3},
                       {"with correction", "", 3}});
  for (const diagnosis::LevelComparison& level : levels)
    table.add_row({level.level_m_s2, signals::to_string(level.direction),
                   level.held_out ? "no" : "yes", level.measured_peak.frequency_hz,
                   level.simulated_peak.frequency_hz, level.updated_peak.frequency_hz,
                   100. * (level.updated_peak.frequency_hz / level.measured_peak.frequency_hz - 1.),
                   report::Cell(level.branch_end_hz), level.measured_peak.amplitude,
                   level.updated_peak.amplitude});
  return table;
}

report::Table ranking_table(const diagnosis::Diagnosis& diagnosis) {
  report::Table table({{"answer", ""},
                       {"probability", "", 3},
                       {"prediction error before", "", 3},
                       {"after correction", "", 3},
                       {"noise floor", "", 3},
                       {"gap closed", "", 3}});
  for (const diagnosis::RankedAnswer& answer : diagnosis.ranking) {
    std::vector<report::Cell> row{answer.name, answer.probability};
    if (answer.held_out) {
      const diagnosis::ErrorScore& score = answer.held_out->overall;
      row.insert(row.end(), {score.nrmse_before, score.nrmse_after, score.noise_floor,
                             report::Cell(score.gap_closed)});
    } else {
      row.resize(6);
    }
    table.add_row(std::move(row));
  }
  return table;
}

}  // namespace vibrissa::views
