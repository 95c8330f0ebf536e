#pragma once

#include "checks/record_report.h"

namespace vibrissa::checks {

/// What a record is and what is wrong with it, without a simulation: each channel by itself, the
/// drive, the relation between base acceleration and base moment, and the checks that `identify`,
/// `separate` and `diagnose` make themselves (signals/record/unusable_channel.h,
/// signals/record/plausibility.h, diagnosis/checks/data_checks.h). Never throws for what a record
/// contains. Proven by tests/checks/check_record_test.cc: 60 good and 60 bad records.
RecordReport check_record(const signals::DatasetRecord& entry);

/// The same with a guessed excitation (signals/files/dataset.h).
RecordReport check_record(const signals::Record& record, const std::string& name = "");

/// Those findings that make a number of `identify` and `separate` wrong, from the checks that take
/// no time.
std::vector<Finding> recording_faults(const signals::DatasetRecord& entry);

}  // namespace vibrissa::checks
