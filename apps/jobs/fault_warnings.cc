#include "apps/jobs/fault_warnings.h"

#include <iostream>

#include "checks/check_record.h"

namespace vibrissa::apps {

void warn_of_faults(const std::string& file, const signals::Record& record,
                    const signals::Excitation& excitation) {
  const signals::DatasetRecord entry{.name = file, .record = record, .excitation = excitation};
  for (const checks::Finding& finding : checks::recording_faults(entry))
    if (finding.severity != checks::Severity::note &&
        finding.kind != diagnosis::FindingKind::wrong_unit)
      std::cerr << "warning: " << file << ": " << finding.sentence << std::endl;
}

}  // namespace vibrissa::apps
