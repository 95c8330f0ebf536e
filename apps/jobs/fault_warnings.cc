#include "apps/jobs/fault_warnings.h"

#include <iostream>

#include "apps/command_line/record_options.h"
#include "checks/check_record.h"
#include "signals/record/plausibility.h"

namespace vibrissa::apps {

namespace {

void warn(const std::string& file, const signals::Record& record,
          const signals::Excitation& excitation) {
  const signals::DatasetRecord entry{.name = file, .record = record, .excitation = excitation};
  for (const checks::Finding& finding : checks::recording_faults(entry))
    if (finding.severity != checks::Severity::note &&
        finding.kind != diagnosis::FindingKind::wrong_unit)
      std::cerr << "warning: " << file << ": " << finding.sentence << std::endl;
}

void report_input(const sensor_case::RecordedInput& input, const std::string& channel,
                  const signals::Excitation& excitation) {
  const signals::Recording recording = sensor_case::read_input(input, channel);
  say_how_read(input.file.string(), recording.words);
  const signals::Record& record = recording.pieces[recording.longest()];
  for (const std::string& remark : signals::implausible_magnitudes(record))
    std::cerr << "warning: " << input.file.string() << ": " << remark << std::endl;
  warn(input.file.string(), record, excitation);
}

}  // namespace

void warn_of_faults(const std::string& file, const signals::Record& record) {
  // Both commands take the record as one of base motion.
  warn(file, record, {.base = true});
}

void report_recorded_inputs(const sensor_case::Case& parameters) {
  if (parameters.base.kind == sensor_case::BaseMotionKind::recorded)
    report_input(parameters.base.recorded, signals::channel::base_acceleration, {.base = true});
  if (parameters.sensor.wind.kind == flow::WindKind::recorded)
    report_input(parameters.wind_record, signals::channel::wind_speed, {.wind = true});
}

}  // namespace vibrissa::apps
