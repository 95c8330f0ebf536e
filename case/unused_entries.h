#pragma once

#include <string>

#include "case/case_file.h"

namespace vibrissa::sensor_case {

/// What a command makes of a case: mesh_export is a mesh written for another program,
/// record_and_model a record and the reduced model.
enum class CaseUse {
  mesh,
  mesh_export,
  modes,
  response,
  record,
  record_and_model,
  whole_job,
  transient
};

/// Why an entry changes nothing for this use of the case ("'modes' does not use it", "Wind/Kind is
/// none"), or empty where it has an effect. path: SECTION/ENTRY. Proven by
/// tests/apps/unused_options_test.cc.
std::string why_unused(CaseUse use, const CaseFile& file, const std::string& path);

}  // namespace vibrissa::sensor_case
