#include "views/run/run_page.h"

#include <algorithm>

#include "views/records/identification_report.h"

namespace vibrissa::views {
namespace {

std::string four_digits(const double value) {
  return report::Cell(value).rounded(4);
}

std::vector<report::Figure> named(const RunPageParts& parts,
                                  const std::vector<std::string>& names) {
  std::vector<report::Figure> figures;
  for (const report::Figure& figure : parts.figures)
    if (std::find(names.begin(), names.end(), figure.name) != names.end())
      figures.push_back(figure);
  return figures;
}

/// Signal-to-distortion ratio of a method; nothing where there is no score.
std::optional<double> sdr_db(const RunPageParts& parts, const std::string& name) {
  for (const SeparatedSignal& signal : parts.separated)
    if (signal.name == name) return signal.sdr_db;
  return std::nullopt;
}

std::vector<report::KeyNumber> key_numbers(const RunPageParts& parts) {
  std::vector<report::KeyNumber> numbers{
      {"First resonance", four_digits(parts.resonance_hz) + " Hz",
       "damping ratio " + four_digits(parts.damping_ratio)},
      {"Fit of the identified model", four_digits(parts.identified.held_out_fit_percent) + " %",
       "on held-out data"}};
  const auto separated = sdr_db(parts, "bvrm"), raw = sdr_db(parts, "nothing removed");
  if (separated && raw)
    numbers.push_back({"Signal-to-distortion ratio of the wind moment",
                       four_digits(*separated) + " dB",
                       "without separation " + four_digits(*raw) + " dB"});
  return numbers;
}

std::string headline(const RunPageParts& parts) {
  std::string text = "The first resonance is at " + four_digits(parts.resonance_hz) + " Hz";
  const auto separated = sdr_db(parts, "bvrm"), raw = sdr_db(parts, "nothing removed");
  if (separated && raw)
    text +=
        "; removing the vibration improves the signal-to-distortion ratio of the wind moment by " +
        report::Cell(*separated - *raw).rounded(3) + " dB";
  return text;
}

}  // namespace

report::Page run_page(const RunPageParts& parts) {
  report::PageSection resonances{.heading = "Resonances",
                                 .tables = {{"modes", "Modes of the sensor", parts.modes}},
                                 .scenes = parts.shapes};
  report::PageSection response{
      .heading = "Response to base vibration",
      .text = {"Base vibration response model of order " + std::to_string(parts.identified.order) +
               "."},
      .tables = {{"identified", "Identified modes with standard deviations (sd)",
                  identification_table(parts.identified.fit)}},
      .figures = named(parts, {"bode"})};
  report::PageSection records{.heading = "Records", .figures = named(parts, {"records"})};
  report::PageSection separation{
      .heading = "Separation of wind and vibration",
      .text = {metric_notes(parts.settling_s)},
      .tables = {{"metrics", "Scores of the methods against the true wind moment",
                  separation_table(parts.separated)}},
      .figures = named(parts, {"separation", "spectra"})};
  report::Page page{.title = "Run: from mesh to separated signals",
                    .headline = headline(parts),
                    .numbers = key_numbers(parts),
                    .sections = {std::move(resonances), std::move(response), std::move(records),
                                 std::move(separation)}};
  if (parts.calibration_note)
    page.verdict.push_back("Calibration: " + *parts.calibration_note + ".");
  return page;
}

}  // namespace vibrissa::views
