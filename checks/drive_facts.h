#pragma once

#include "checks/record_report.h"

namespace vibrissa::checks {

/// How the base was driven, from base_acceleration. Hits: separation/segments/hit_blocks.h. Period:
/// the shortest lag of two or more periods within the record at which the autocorrelation is within
/// three deviations of its largest value, above 0.9. End: the split after which the variance is
/// below a tenth, by the likelihood of the variances of parts.
/// Proven by tests/checks/drive_facts_test.cc.
DriveFacts drive_facts(const signals::Record& record);

/// Findings about the drive: one hit only, and a drive that ended before the third of the record
/// that scores a model.
void find_drive_faults(const signals::Record& record, const DriveFacts& drive,
                       std::vector<Finding>& findings);

}  // namespace vibrissa::checks
