#include "checks/report_text.h"

#include <algorithm>
#include <cmath>

#include "checks/numbered_reasons.h"
#include "diagnosis/model/words.h"
#include "signals/base/significant_digits.h"

namespace vibrissa::checks {
namespace {

using diagnosis::three_digits;

std::string wrapped(const std::string& line) {
  return diagnosis::joined(diagnosis::wrapped(line), "\n") + "\n";
}

std::string channel_text(const ChannelFacts& facts) {
  const std::string unit = facts.unit.empty() ? "" : " " + facts.unit;
  std::string text = "  " + facts.name + ": " + three_digits(facts.lowest) + " .. " +
                     three_digits(facts.highest) + unit + ", mean " + three_digits(facts.mean) +
                     ", rms " + three_digits(facts.rms);
  if (facts.noise) text += ", noise at most " + three_digits(*facts.noise);
  if (facts.step) text += ", step " + three_digits(*facts.step);
  if (facts.drift_per_s) text += ", drift " + three_digits(*facts.drift_per_s) + unit + "/s";
  for (const HumLine& line : facts.hum)
    text += ", hum " + three_digits(line.frequency_hz) + " Hz " + three_digits(line.rms);
  return wrapped(text);
}

std::string drive_text(const DriveFacts& drive) {
  if (drive.kind == DriveKind::none) return "";
  std::string text = "  drive: " + to_string(drive.kind);
  if (drive.period_samples > 0)
    text += ", repeats after " + std::to_string(drive.period_samples) + " samples";
  if (drive.n_hits > 0) text += ", " + std::to_string(drive.n_hits);
  text += "; level in the thirds of the record";
  for (const double level : drive.level_m_s2) text += " " + three_digits(level);
  return wrapped(text + " m/s2 rms");
}

std::string response_text(const ResponseFacts& response) {
  std::string text = "  response: coherent from " + three_digits(response.band.low_hz) + " to " +
                     three_digits(response.band.high_hz) + " Hz, at " +
                     std::to_string(response.n_coherent) + " of " +
                     std::to_string(response.n_lines) + " lines";
  if (response.coherent_share)
    text += "; " + diagnosis::percent(response.coherent_share->value) +
            " of the moment's variance follows the base";
  if (response.delay_s)
    text += "; the moment is " + three_digits(1e3 * std::abs(response.delay_s->value)) +
            (response.delay_s->value < 0. ? " ms early" : " ms late");
  return wrapped(text);
}

std::string number_text(const std::optional<std::size_t>& number) {
  return number ? "[" + std::to_string(*number) + "] " : "";
}

std::string record_text(const RecordReport& report, const std::size_t place,
                        const NumberedReasons& reasons) {
  std::string text =
      wrapped(report.name + ": " + signals::rate_text(report.sampling_rate_hz) + ", " +
              std::to_string(report.n_samples) + " samples, " + three_digits(report.duration_s) +
              " s, excitation " + signals::to_string(report.excitation));
  if (!report.reading.empty()) text += wrapped("  read as: " + report.reading);
  for (const ChannelFacts& facts : report.channels) text += channel_text(facts);
  text += drive_text(report.drive);
  if (report.response && report.response->n_coherent > 0) text += response_text(*report.response);
  std::string repeated;
  for (std::size_t i = 0; i < report.findings.size(); ++i) {
    const std::string number = number_text(reasons.of_finding(place, i));
    if (reasons.is_repeated(place, i))
      repeated += number;
    else
      text += wrapped("  " + number + to_string(report.findings[i].severity) + ": " +
                      report.findings[i].sentence);
  }
  if (!repeated.empty()) text += "  as above: " + repeated + "\n";
  return text;
}

}  // namespace

std::string check_text(const CheckResult& result) {
  const NumberedReasons reasons(result);
  std::string text;
  for (std::size_t i = 0; i < result.records.size(); ++i)
    text += record_text(result.records[i], i, reasons);
  for (const std::string& guess : result.guesses) text += wrapped("guessed: " + guess);
  text += "\n";
  for (const CommandVerdict& verdict : result.serves) {
    std::string head = verdict.command;
    head.resize(10, ' ');
    text += head + to_string(verdict.serves) +
            (verdict.reasons.empty() ? "" : ": " + reasons.of_command(verdict)) + "\n";
  }
  for (const auto& [number, sentence] : reasons.others())
    text += wrapped("[" + std::to_string(number) + "] " + sentence);
  return text;
}

}  // namespace vibrissa::checks
