#include "checks/serves.h"

#include <algorithm>
#include <map>

#include "signals/record/channel_name.h"

namespace vibrissa::checks {
namespace {

using diagnosis::FindingKind;
namespace channel = signals::channel;

constexpr std::size_t identify = 0, separate = 1, diagnose = 2, plan = 3;
constexpr Serves good = Serves::good, limited = Serves::limited, no = Serves::no;

using Effect = std::array<Serves, 4>;

/// What a finding does to identify, separate, diagnose and plan.
const std::map<FindingKind, Effect>& effects() {
  static const std::map<FindingKind, Effect> all{
      {FindingKind::missing_channel, {no, no, no, no}},
      {FindingKind::not_finite, {no, no, no, no}},
      {FindingKind::constant_channel, {no, no, no, no}},
      {FindingKind::no_base_motion, {no, no, no, no}},
      {FindingKind::no_coherence, {no, no, no, no}},
      {FindingKind::few_lines, {no, no, limited, no}},
      {FindingKind::poor_coherence, {limited, limited, limited, limited}},
      {FindingKind::swapped_columns, {no, no, no, no}},
      {FindingKind::wrong_unit, {limited, limited, limited, limited}},
      {FindingKind::reversed_sign, {good, good, limited, limited}},
      {FindingKind::clipped_channel, {limited, limited, limited, limited}},
      {FindingKind::stuck_channel, {limited, limited, no, limited}},
      {FindingKind::spike, {limited, limited, no, limited}},
      {FindingKind::broken_period, {good, good, no, good}},
      {FindingKind::moves_at_rest, {good, good, no, good}},
      {FindingKind::drive_ended, {limited, good, limited, limited}},
      {FindingKind::one_hit, {limited, good, limited, limited}},
      {FindingKind::possible_aliasing, {limited, limited, limited, limited}},
      {FindingKind::changing_response, {limited, limited, limited, limited}},
      {FindingKind::few_steps, {limited, limited, limited, limited}},
      {FindingKind::too_short, {limited, limited, limited, limited}},
      {FindingKind::hum, {limited, limited, limited, limited}},
      {FindingKind::drift, {limited, limited, limited, limited}},
      {FindingKind::channel_delay, {limited, limited, limited, limited}},
      {FindingKind::no_usable_model, {limited, limited, good, limited}},
      {FindingKind::missing_wind, {good, good, limited, limited}},
      {FindingKind::missing_acceleration, {no, no, limited, limited}},
      {FindingKind::no_quiet_record, {good, good, limited, good}},
      {FindingKind::no_held_out, {good, good, limited, good}},
      {FindingKind::one_level, {good, good, limited, good}},
      {FindingKind::no_wind, {good, good, limited, limited}}};
  return all;
}

Serves effect_of(const Finding& finding, std::size_t command) {
  if (finding.severity == Severity::note) return good;
  const auto found = effects().find(finding.kind);
  if (found == effects().end()) return finding.severity == Severity::stops ? no : limited;
  const Serves serves = found->second[command];
  // The same kind can be too much for a model: too little of the moment follows the base.
  const bool is_hopeless = finding.kind == FindingKind::poor_coherence &&
                           finding.severity == Severity::stops && command == identify;
  return is_hopeless ? no : serves;
}

/// Wind and its response are told without base motion, and a weak base beside the wind in part.
Serves with_wind(const RecordReport& report, const Finding& finding, std::size_t command,
                 Serves serves) {
  if (serves != no || command < diagnose || !report.excitation.wind || !report.has_wind_speed)
    return serves;
  if (finding.channel == channel::base_acceleration) return good;
  const bool is_weak =
      finding.kind == FindingKind::no_coherence || finding.kind == FindingKind::few_lines;
  return is_weak ? limited : serves;
}

bool is_at_rest(const RecordReport& report) {
  return report.excitation == signals::Excitation{};
}

void worsen(CommandVerdict& verdict, Serves serves, const std::string& sentence) {
  if (serves == good) return;
  if (serves > verdict.serves) {
    verdict.serves = serves;
    if (serves == no) verdict.reasons.clear();
  }
  if (serves == verdict.serves &&
      std::ranges::find(verdict.reasons, sentence) == verdict.reasons.end())
    verdict.reasons.push_back(sentence);
}

Serves of_severity(Severity severity) {
  return severity == Severity::stops ? no : limited;
}

ServesTable empty_table() {
  ServesTable table;
  table[identify].command = "identify";
  table[separate].command = "separate";
  table[diagnose].command = "diagnose";
  table[plan].command = "plan";
  return table;
}

}  // namespace

std::string to_string(const Serves serves) {
  if (serves == Serves::good) return "good";
  return serves == Serves::limited ? "limited" : "no";
}

ServesTable what_it_serves(const RecordReport& report) {
  ServesTable table = empty_table();
  for (std::size_t command = 0; command < table.size(); ++command)
    for (const Finding& finding : report.findings) {
      const Serves serves = with_wind(report, finding, command, effect_of(finding, command));
      worsen(table[command], serves, finding.sentence);
    }
  return table;
}

namespace {

/// Under base motion and wind together little of the moment follows the base, which harms nothing
/// where another record gives the response to the base.
RecordReport beside_a_good_one(RecordReport report) {
  if (!report.excitation.wind) return report;
  std::erase_if(report.findings, [](const Finding& finding) {
    return finding.kind == FindingKind::no_usable_model ||
           finding.kind == FindingKind::poor_coherence || finding.kind == FindingKind::few_lines ||
           finding.kind == FindingKind::no_coherence;
  });
  return report;
}

}  // namespace

ServesTable what_they_serve(std::span<const RecordReport> reports,
                            const std::vector<Finding>& of_dataset) {
  ServesTable table = empty_table();
  bool is_first = true;
  for (const RecordReport& report : reports) {
    const ServesTable own = what_it_serves(report);
    for (const std::size_t command : {identify, separate})
      if (is_first || own[command].serves < table[command].serves) table[command] = own[command];
    is_first = false;
  }
  const bool has_model = !is_first && reports.size() > 1 && table[identify].serves == good;
  for (const RecordReport& report : reports) {
    // A record at rest gives the noise beside others.
    if (is_at_rest(report) && !std::ranges::all_of(reports, is_at_rest)) continue;
    const ServesTable own = what_it_serves(has_model ? beside_a_good_one(report) : report);
    for (const std::size_t command : {diagnose, plan})
      for (const std::string& reason : own[command].reasons)
        worsen(table[command], own[command].serves,
               reports.size() > 1 ? report.name + ": " + reason : reason);
  }
  for (const Finding& finding : of_dataset)
    for (const std::size_t command : {diagnose, plan})
      worsen(table[command], std::min(effect_of(finding, command), of_severity(finding.severity)),
             finding.sentence);
  return table;
}

bool only_names_are_missing(std::span<const RecordReport> reports) {
  return std::ranges::all_of(reports, [](const RecordReport& report) {
    return std::ranges::all_of(report.findings,
                               [](const Finding& finding) {
                                 return finding.severity != Severity::stops ||
                                        finding.kind == FindingKind::missing_channel;
                               }) &&
           std::ranges::all_of(report.channels, [](const ChannelFacts& facts) {
             return signals::full_channel_name(facts.name).empty();
           });
  });
}

bool serves_all(const ServesTable& table) {
  return std::ranges::none_of(table, [](const CommandVerdict& v) { return v.serves == no; });
}

}  // namespace vibrissa::checks
