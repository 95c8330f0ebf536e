#pragma once

#include <string>

#include "case/case_file.h"

namespace vibrissa::sensor_case {

/// What a command makes of a case.
enum class CaseUse { mesh, modes, response, record, whole_job, transient };

/// Why an entry changes nothing for this use of the case ("'modes' does not use it", "Wind/Kind is
/// none"), or empty where it has an effect. path: SECTION/ENTRY. Proven by
/// tests/apps/unused_options_test.cc.
std::string why_unused(CaseUse use, const CaseFile& file, const std::string& path);

}  // namespace vibrissa::sensor_case
