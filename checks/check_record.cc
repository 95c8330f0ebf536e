#include "checks/check_record.h"

#include <algorithm>

#include "checks/channel_facts.h"
#include "checks/drive_facts.h"
#include "checks/response_facts.h"
#include "checks/same_quantity.h"
#include "diagnosis/checks/data_checks.h"
#include "diagnosis/model/words.h"
#include "diagnosis/records/experiment.h"
#include "separation/identification/order_selection.h"
#include "separation/verdict/coherence.h"
#include "signals/base/error.h"
#include "signals/record/plausibility.h"
#include "signals/record/unusable_channel.h"

namespace vibrissa::checks {
namespace {

using diagnosis::FindingKind;
namespace channel = signals::channel;

Severity severity_of(FindingKind kind) {
  if (diagnosis::spoils_everything(kind)) return Severity::stops;
  const bool is_missing =
      kind == FindingKind::missing_wind || kind == FindingKind::missing_acceleration;
  return diagnosis::casts_doubt(kind) || is_missing ? Severity::limits : Severity::note;
}

/// The channel that a message of the diagnosis begins with.
std::string channel_in(const signals::Record& record, const std::string& message) {
  for (const std::string& name : record.channel_names())
    if (message.starts_with(name)) return name;
  return "";
}

void find_missing(const signals::Record& record, const std::string& name, const std::string& advice,
                  std::vector<Finding>& findings) {
  if (!record.has(name))
    findings.push_back({FindingKind::missing_channel,
                        name,
                        {},
                        "",
                        "no column is " + name + " (there are: " +
                            diagnosis::joined(record.channel_names(), ", ") + "): " + advice,
                        Severity::stops});
}

void find_unusable(const signals::Record& record, const signals::Excitation& moved,
                   std::vector<Finding>& findings) {
  for (const std::string& name : record.channel_names()) {
    const auto unusable = signals::unusable_channel(record, name);
    if (!unusable) continue;
    const bool may_rest =
        name != channel::base_moment && (name != channel::base_acceleration || moved.wind);
    findings.push_back(
        {unusable->is_constant ? FindingKind::constant_channel : FindingKind::not_finite,
         name,
         {},
         "",
         name + " " + unusable->reason + ": check its column, its cable and its power",
         unusable->is_constant && may_rest ? Severity::note : Severity::stops});
  }
}

bool is_found(const std::vector<Finding>& findings, FindingKind kind, const std::string& name) {
  return std::ranges::any_of(findings, [&](const Finding& finding) {
    return finding.kind == kind && finding.channel == name;
  });
}

bool can_respond(const signals::Record& record) {
  for (const std::string& name : {channel::base_acceleration, channel::base_moment})
    if (!record.has(name) || signals::unusable_channel(record, name)) return false;
  return true;
}

void add_noise(const signals::DatasetRecord& entry, RecordReport& report) {
  signals::Dataset dataset;
  dataset.records = {entry};
  dataset.records.front().split = signals::Split::fit;
  const diagnosis::ChannelNoise noise = diagnosis::channel_noise(dataset);
  for (ChannelFacts& facts : report.channels) {
    if (facts.name == channel::base_moment) facts.noise = noise.moment_n_m;
    if (facts.name == channel::base_acceleration) facts.noise = noise.acceleration_m_s2;
  }
}

void check_pair(const signals::DatasetRecord& entry, RecordReport& report) {
  const signals::Record& record = entry.record;
  if (!can_respond(record)) return;
  add_noise(entry, report);
  if (!entry.excitation.base) {
    report.findings.push_back(
        {FindingKind::no_base_motion,
         channel::base_acceleration,
         {},
         "",
         "the base does not move: base_acceleration_m_s2 is noise; drive the base",
         Severity::stops});
    return;
  }
  report.drive = drive_facts(record);
  find_drive_faults(record, report.drive, report.findings);
  ChannelHum hum;
  for (const ChannelFacts& facts : report.channels) {
    if (facts.name == channel::base_acceleration) hum.acceleration = facts.hum;
    if (facts.name == channel::base_moment) hum.moment = facts.hum;
  }
  report.response = response_facts(record, report.drive, hum, report.findings);
}

void check_length(const signals::Record& record, std::vector<Finding>& findings) {
  // The last third scores the model and is not fitted.
  const std::size_t fewest = separation::fewest_samples_for_order * 3 / 2;
  if (record.n_samples() < fewest)
    findings.push_back({FindingKind::too_short, "", double(record.n_samples()), "samples",
                        std::to_string(record.n_samples()) +
                            " samples are too few to choose the order of a model by data that it "
                            "has not seen; record at least " +
                            std::to_string(fewest),
                        Severity::limits});
}

}  // namespace

std::vector<Finding> recording_faults(const signals::DatasetRecord& entry) {
  std::vector<Finding> out;
  find_unusable(entry.record, entry.excitation, out);
  if (std::ranges::any_of(out, [](const Finding& f) { return f.kind == FindingKind::not_finite; }))
    return out;
  std::vector<diagnosis::Finding> found;
  if (entry.record.has(channel::base_moment))
    diagnosis::check_recording(entry, found);
  else
    diagnosis::check_samples(entry, found);
  for (const diagnosis::Finding& finding : found) {
    const std::string name = channel_in(entry.record, finding.message);
    if (!is_found(out, finding.kind, name))
      out.push_back({finding.kind, name, {}, "", finding.message, severity_of(finding.kind)});
  }
  for (const std::string& remark : signals::implausible_magnitudes(entry.record))
    out.push_back({FindingKind::wrong_unit,
                   channel_in(entry.record, remark),
                   {},
                   "",
                   remark,
                   Severity::limits});
  return out;
}

RecordReport check_record(const signals::DatasetRecord& entry) {
  const signals::Record& record = entry.record;
  RecordReport report{.name = entry.name,
                      .sampling_rate_hz = record.sampling_rate_hz(),
                      .start_s = record.time_s(0),
                      .duration_s = record.duration_s(),
                      .n_samples = record.n_samples(),
                      .excitation = entry.excitation,
                      .split = entry.split,
                      .has_wind_speed = record.has(channel::wind_speed)};
  find_missing(record, channel::base_moment,
               "name it with its unit, as in --column 'base_moment=hall[mN mm]'", report.findings);
  if (!entry.excitation.wind)
    find_missing(record, channel::base_acceleration,
                 "name it with its unit, as in --column 'base_acceleration=ax[g]'; without it, "
                 "'vibrissa identify --output-only' gives resonances and damping alone, and "
                 "--ring-down, after flicks or hits, gives them against the amplitude",
                 report.findings);
  const std::vector<Finding> faults = recording_faults(entry);
  report.findings.insert(report.findings.end(), faults.begin(), faults.end());
  check_length(record, report.findings);
  for (const std::string& name : record.channel_names()) {
    report.channels.push_back(channel_facts(record, name));
    find_channel_faults(report.channels.back(), record.sampling_rate_hz(), report.findings);
  }
  if (std::ranges::none_of(report.findings, [](const Finding& finding) {
        return finding.kind == FindingKind::not_finite;
      })) {
    check_same_quantities(record, report.findings);
    check_pair(entry, report);
  }
  std::ranges::stable_sort(report.findings, std::ranges::greater{}, &Finding::severity);
  return report;
}

RecordReport check_record(const signals::Record& record, const std::string& name) {
  signals::Excitation excitation = signals::guessed_excitation(record);
  // A weak drive looks like noise, but the moment follows it.
  if (!excitation.base && can_respond(record)) {
    const auto found = separation::coherent_lines(record);
    excitation.base = found && found->lines.size() >= fewest_coherent_lines;
  }
  return check_record(
      signals::DatasetRecord{.name = name, .record = record, .excitation = excitation});
}

}  // namespace vibrissa::checks
