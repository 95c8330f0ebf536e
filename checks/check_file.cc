#include "checks/check_file.h"

#include <algorithm>

#include "diagnosis/checks/data_checks.h"
#include "signals/record/channel_name.h"

namespace vibrissa::checks {
namespace {

using diagnosis::FindingKind;
namespace fs = std::filesystem;
namespace channel = signals::channel;

/// Whether all excitations of a record are measured.
bool is_measured(const signals::DatasetRecord& entry) {
  return entry.record.has(channel::base_moment) &&
         (!entry.excitation.base || entry.record.has(channel::base_acceleration)) &&
         (!entry.excitation.wind || entry.record.has(channel::wind_speed));
}

std::vector<Finding> findings_about_all(const signals::Dataset& dataset) {
  std::vector<diagnosis::Finding> found;
  diagnosis::check_rest(dataset, found);
  diagnosis::check_what_is_there({}, is_measured, dataset, found);
  std::vector<Finding> out;
  for (const diagnosis::Finding& finding : found)
    out.push_back(
        {finding.kind,
         "",
         {},
         "",
         finding.record.empty() ? finding.message : finding.record + ": " + finding.message,
         diagnosis::spoils_everything(finding.kind) ? Severity::stops : Severity::limits});
  return out;
}

void settle(CheckResult& result, const signals::Dataset& dataset) {
  bool has_moment = true;
  for (const signals::DatasetRecord& entry : dataset.records)
    has_moment &= entry.record.has(channel::base_moment);
  if (has_moment) result.of_dataset = findings_about_all(dataset);
  result.serves = what_they_serve(result.records, result.of_dataset);
}

void add(CheckResult& result, signals::Dataset& dataset, const signals::Record& record,
         const std::string& name) {
  result.records.push_back(check_record(record, name));
  result.samples.push_back(record);
  const std::size_t n_fit = record.n_samples() * 2 / 3;
  const signals::Excitation excitation = result.records.back().excitation;
  dataset.records.push_back(
      {.name = name, .record = record.slice(0, n_fit), .excitation = excitation});
  dataset.records.push_back({.name = name + "_last_third",
                             .record = record.slice(n_fit, record.n_samples() - n_fit),
                             .excitation = excitation,
                             .split = signals::Split::held_out});
}

}  // namespace

CheckResult check_dataset(const std::string& source, const signals::Dataset& dataset) {
  CheckResult result{.source = source, .guesses = dataset.guesses};
  for (std::size_t i = 0; i < dataset.records.size(); ++i) {
    result.records.push_back(check_record(dataset.records[i]));
    if (dataset.readings.size() == dataset.records.size())
      result.records.back().reading = dataset.readings[i].words;
    result.samples.push_back(dataset.records[i].record);
  }
  settle(result, dataset);
  return result;
}

CheckResult check_one(const std::string& source, const signals::Record& record,
                      const std::string& reading) {
  CheckResult result{.source = source};
  signals::Dataset dataset;
  add(result, dataset, record, fs::path(source).stem().string());
  result.records.back().reading = reading;
  settle(result, dataset);
  return result;
}

CheckResult check_file(const fs::path& source, const signals::ReadOptions& options) {
  const bool is_description = source.filename() == "dataset.json";
  if (is_description || fs::is_directory(source)) {
    const fs::path parent = source.has_parent_path() ? source.parent_path() : fs::path(".");
    return check_dataset(source.string(),
                         signals::read_dataset(is_description ? parent : source, options));
  }
  signals::ReadOptions used = options;
  used.takes_all_columns = std::ranges::all_of(
      options.columns, [](const auto& choice) { return choice.channel == signals::time_channel; });
  const signals::Recording recording = signals::read_recording(source, used);
  if (recording.pieces.size() == 1)
    return check_one(source.string(), recording.pieces.front(), recording.words);
  CheckResult result{.source = source.string()};
  signals::Dataset dataset;
  for (std::size_t i = 0; i < recording.pieces.size(); ++i)
    add(result, dataset, recording.pieces[i], source.stem().string() + "_" + std::to_string(i + 1));
  result.records.front().reading = recording.words;
  settle(result, dataset);
  return result;
}

}  // namespace vibrissa::checks
