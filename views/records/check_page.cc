#include "views/records/check_page.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "checks/numbered_reasons.h"
#include "diagnosis/model/words.h"
#include "separation/verdict/coherence.h"
#include "signals/base/significant_digits.h"
#include "signals/record/channel_name.h"
#include "signals/record/unusable_channel.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::views {
namespace {

namespace channel = signals::channel;
constexpr std::size_t most_figures = 12;

std::string figure_name(std::size_t number) {
  return "record_" + std::to_string(number + 1);
}

/// At most so many points of a trace, so that a page stays small.
report::Curve trace_of(const signals::Record& record, const std::string& name) {
  constexpr std::size_t most_points = 20000;
  const auto x = record.channel(name);
  const std::size_t n = std::min(x.size(), most_points);
  report::Curve curve{.label = name};
  for (std::size_t i = 0; i < n; ++i) {
    curve.x.push_back(record.time_s(i));
    curve.y.push_back(x[i]);
  }
  return curve;
}

/// "m/s2", or 1 where the name states no unit.
std::string density_unit(const std::string& name) {
  const std::string unit = signals::unit_of_ending(signals::unit_at_the_end(name));
  return unit.empty() ? "1" : unit;
}

void add_channel(const signals::Record& record, const std::string& name, report::Figure& figure) {
  if (signals::unusable_channel(record, name)) return;
  figure.panels.push_back(
      {.title = name, .x_label = "Time [s]", .y_label = name, .curves = {trace_of(record, name)}});
  const std::size_t segment =
      std::clamp<std::size_t>(std::bit_floor(record.n_samples() / 8), 32, 4096);
  if (record.n_samples() < 2 * segment) return;
  const auto spectrum = signals::welch_spectrum(record.channel(name), record.sampling_rate_hz(),
                                                {.segment_samples = segment});
  report::Curve curve{.x = spectrum.frequency_hz};
  for (const double density : spectrum.density) curve.y.push_back(std::sqrt(density));
  figure.panels.push_back({.title = "Spectrum of " + name,
                           .x_label = "Frequency [Hz]",
                           .y_label = density_unit(name) + "/√Hz",
                           .log_y = true,
                           .curves = {std::move(curve)}});
}

void add_coherence(const signals::Record& record, report::Figure& figure) {
  for (const std::string& name : {channel::base_acceleration, channel::base_moment})
    if (!record.has(name) || signals::unusable_channel(record, name)) return;
  const auto found = separation::coherent_lines(record);
  if (!found) return;
  const auto& f = found->response.frequency_hz;
  figure.panels.push_back(
      {.title = "Coherence of base acceleration and base moment",
       .x_label = "Frequency [Hz]",
       .y_label = "Coherence",
       .y_range = report::Range{0., 1.},
       .curves = {{.label = "coherence", .x = f, .y = found->response.coherence},
                  {.label = "limit of unrelated noise",
                   .style = report::CurveStyle::dashed,
                   .x = {f.front(), f.back()},
                   .y = {found->limit, found->limit}}}});
}

report::Figure figure_of(const signals::Record& record, const checks::RecordReport& report,
                         std::size_t number) {
  report::Figure figure{.name = figure_name(number), .title = report.name};
  constexpr std::size_t most_channels = 5;  // two panels each
  for (const std::string& name : record.channel_names())
    if (figure.panels.size() < 2 * most_channels) add_channel(record, name, figure);
  add_coherence(record, figure);
  return figure;
}

report::Table channel_table(const checks::RecordReport& record) {
  report::Table table({{"channel", ""},
                       {"unit", ""},
                       {"lowest", ""},
                       {"highest", ""},
                       {"mean", ""},
                       {"rms about the mean", ""},
                       {"noise (at most)", "", 2},
                       {"step", "", 2},
                       {"drift per second", "", 2},
                       {"hum", ""}});
  for (const checks::ChannelFacts& facts : record.channels) {
    std::string hum;
    for (const checks::HumLine& line : facts.hum)
      hum += (hum.empty() ? "" : ", ") + diagnosis::three_digits(line.frequency_hz) + " Hz " +
             diagnosis::three_digits(line.rms);
    table.add_row({facts.name, facts.unit, facts.lowest, facts.highest, facts.mean, facts.rms,
                   facts.noise, facts.step, facts.drift_per_s, hum});
  }
  return table;
}

report::Table finding_table(const checks::RecordReport& record, const std::size_t place,
                            const checks::NumberedReasons& reasons) {
  report::Table table({{"number", ""},
                       {"severity", ""},
                       {"kind", ""},
                       {"channel", ""},
                       {"value", ""},
                       {"unit", ""},
                       {"finding", ""}});
  for (std::size_t i = 0; i < record.findings.size(); ++i) {
    const checks::Finding& finding = record.findings[i];
    const auto number = reasons.of_finding(place, i);
    table.add_row({number ? "[" + std::to_string(*number) + "]" : "",
                   checks::to_string(finding.severity), diagnosis::to_string(finding.kind),
                   finding.channel, finding.value, finding.unit, finding.sentence});
  }
  return table;
}

report::PageSection section_of(const checks::RecordReport& record, const std::size_t place,
                               const checks::NumberedReasons& reasons, const std::size_t number) {
  report::PageSection section{.heading = record.name,
                              .text = {signals::rate_text(record.sampling_rate_hz) + ", " +
                                       std::to_string(record.n_samples) + " samples, " +
                                       diagnosis::three_digits(record.duration_s) +
                                       " s, excitation " + signals::to_string(record.excitation) +
                                       ", drive " + checks::to_string(record.drive.kind) + "."}};
  if (!record.reading.empty()) section.text.push_back("Read as: " + record.reading + ".");
  section.tables.push_back({.name = "channels_" + std::to_string(number + 1),
                            .caption = "Channels",
                            .table = channel_table(record)});
  if (!record.findings.empty())
    section.tables.push_back({.name = "findings_" + std::to_string(number + 1),
                              .caption = "Findings",
                              .table = finding_table(record, place, reasons)});
  return section;
}

std::string headline_of(std::span<const checks::CheckResult> results) {
  std::string good, not_good;
  for (const checks::CheckResult& result : results)
    for (const checks::CommandVerdict& verdict : result.serves) {
      std::string& list = verdict.serves == checks::Serves::no ? not_good : good;
      list += (list.empty() ? "" : ", ") + verdict.command +
              (verdict.serves == checks::Serves::limited ? " (limited)" : "");
    }
  return (good.empty() ? std::string("No command can work") : "Can work: " + good) +
         (not_good.empty() ? "" : ". Cannot work: " + not_good);
}

}  // namespace

report::Table serves_table(std::span<const checks::CheckResult> results) {
  report::Table table({{"source", ""}, {"command", ""}, {"serves", ""}, {"reasons", ""}});
  for (const checks::CheckResult& result : results) {
    const checks::NumberedReasons reasons(result);
    for (const checks::CommandVerdict& verdict : result.serves)
      table.add_row({result.source, verdict.command, checks::to_string(verdict.serves),
                     reasons.of_command(verdict)});
  }
  return table;
}

std::vector<report::Figure> check_plots(std::span<const checks::CheckResult> results) {
  std::vector<report::Figure> figures;
  std::size_t number = 0;
  for (const checks::CheckResult& result : results)
    for (std::size_t i = 0; i < result.records.size(); ++i, ++number) {
      if (number >= most_figures) return figures;
      report::Figure figure = figure_of(result.samples[i], result.records[i], number);
      if (!figure.panels.empty()) figures.push_back(std::move(figure));
    }
  return figures;
}

report::Page check_page(std::span<const checks::CheckResult> results) {
  report::Page page{.title = "Check of a recording", .headline = headline_of(results)};
  report::PageSection commands{.heading = "What it serves"};
  commands.tables.push_back({.name = "commands",
                             .caption = "Commands that the data serve",
                             .table = serves_table(results)});
  for (const checks::CheckResult& result : results) {
    const checks::NumberedReasons reasons(result);
    for (const auto& [reason, sentence] : reasons.others())
      commands.text.push_back("[" + std::to_string(reason) + "] " + sentence + ".");
    for (const checks::Finding& finding : result.of_dataset)
      if (!reasons.is_reason(finding.sentence)) commands.text.push_back(finding.sentence + ".");
  }
  page.sections.push_back(std::move(commands));
  const std::vector<report::Figure> figures = check_plots(results);
  std::size_t number = 0;
  for (const checks::CheckResult& result : results) {
    const checks::NumberedReasons reasons(result);
    for (std::size_t place = 0; place < result.records.size(); ++place) {
      page.sections.push_back(section_of(result.records[place], place, reasons, number));
      for (const report::Figure& figure : figures)
        if (figure.name == figure_name(number)) page.sections.back().figures.push_back(figure);
      ++number;
    }
  }
  return page;
}

}  // namespace vibrissa::views
