#include "apps/solid/jobs/recorded_inputs.h"

#include <iostream>
#include <string>

#include "apps/command_line/record_options.h"
#include "apps/jobs/fault_warnings.h"
#include "signals/record/plausibility.h"

namespace vibrissa::apps {
namespace {

void report_input(const sensor_case::RecordedInput& input, const std::string& channel,
                  const signals::Excitation& excitation) {
  const signals::Recording recording = sensor_case::read_input(input, channel);
  say_how_read(input.file.string(), recording.words);
  const signals::Record& record = recording.pieces[recording.longest()];
  for (const std::string& remark : signals::implausible_magnitudes(record))
    std::cerr << "warning: " << input.file.string() << ": " << remark << std::endl;
  warn_of_faults(input.file.string(), record, excitation);
}

}  // namespace

void report_recorded_inputs(const sensor_case::Case& parameters) {
  if (parameters.base.kind == sensor_case::BaseMotionKind::recorded)
    report_input(parameters.base.recorded, signals::channel::base_acceleration, {.base = true});
  if (parameters.sensor.wind.kind == flow::WindKind::recorded)
    report_input(parameters.wind_record, signals::channel::wind_speed, {.wind = true});
}

}  // namespace vibrissa::apps
