#pragma once

#include <string>

#include "diagnosis/diagnosis.h"

namespace vibrissa::diagnosis {

/// The diagnosis as docs/records.md describes it, schema "vibrissa-diagnosis-2". Numbers that are
/// not finite become null. Proven by tests/diagnosis/diagnosis_json_test.cc.
std::string diagnosis_json(const Diagnosis& diagnosis);

}  // namespace vibrissa::diagnosis
