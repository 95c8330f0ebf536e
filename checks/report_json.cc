#include "checks/report_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace vibrissa::checks {
namespace {

using nlohmann::json;

json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? json(*value) : json();
}

json channel_json(const ChannelFacts& facts) {
  json hum = json::array();
  for (const HumLine& line : facts.hum)
    hum.push_back({{"frequency_hz", line.frequency_hz}, {"rms", line.rms}});
  return {{"name", facts.name},
          {"unit", facts.unit},
          {"lowest", number(facts.lowest)},
          {"highest", number(facts.highest)},
          {"mean", number(facts.mean)},
          {"rms", number(facts.rms)},
          {"drift_per_s", number(facts.drift_per_s)},
          {"step", number(facts.step)},
          {"noise", number(facts.noise)},
          {"hum", hum}};
}

json estimate_json(const std::optional<separation::Estimate>& estimate) {
  if (!estimate) return nullptr;
  return {{"value", number(estimate->value)},
          {"standard_deviation", number(estimate->standard_deviation)}};
}

json response_json(const std::optional<ResponseFacts>& response) {
  if (!response) return nullptr;
  return {{"band_hz", {response->band.low_hz, response->band.high_hz}},
          {"lines", response->n_lines},
          {"coherent_lines", response->n_coherent},
          {"coherent_share", estimate_json(response->coherent_share)},
          {"delay_s", estimate_json(response->delay_s)},
          {"gain_kg_m", number(response->gain_kg_m)}};
}

json findings_json(const std::vector<Finding>& findings) {
  json out = json::array();
  for (const Finding& finding : findings)
    out.push_back({{"kind", diagnosis::to_string(finding.kind)},
                   {"channel", finding.channel},
                   {"value", number(finding.value)},
                   {"unit", finding.unit},
                   {"severity", to_string(finding.severity)},
                   {"sentence", finding.sentence}});
  return out;
}

json record_json(const RecordReport& report) {
  json channels = json::array();
  for (const ChannelFacts& facts : report.channels) channels.push_back(channel_json(facts));
  return {{"name", report.name},
          {"read_as", report.reading},
          {"sampling_rate_hz", report.sampling_rate_hz},
          {"samples", report.n_samples},
          {"start_s", report.start_s},
          {"duration_s", report.duration_s},
          {"excitation", signals::to_string(report.excitation)},
          {"channels", channels},
          {"drive",
           {{"kind", to_string(report.drive.kind)},
            {"period_samples", report.drive.period_samples},
            {"hits", report.drive.n_hits},
            {"level_m_s2", report.drive.level_m_s2},
            {"end_s", number(report.drive.end_s)}}},
          {"response", response_json(report.response)},
          {"findings", findings_json(report.findings)}};
}

}  // namespace

json check_json(const CheckResult& result) {
  json records = json::array(), serves = json::object();
  for (const RecordReport& report : result.records) records.push_back(record_json(report));
  for (const CommandVerdict& verdict : result.serves)
    serves[verdict.command] = {{"verdict", to_string(verdict.serves)},
                               {"reasons", verdict.reasons}};
  return {{"schema", "vibrissa-check-1"},
          {"source", result.source},
          {"guesses", result.guesses},
          {"records", records},
          {"findings", findings_json(result.of_dataset)},
          {"serves", serves}};
}

json check_json(std::span<const CheckResult> results) {
  if (results.size() == 1) return check_json(results.front());
  json out = json::array();
  for (const CheckResult& result : results) out.push_back(check_json(result));
  return out;
}

}  // namespace vibrissa::checks
