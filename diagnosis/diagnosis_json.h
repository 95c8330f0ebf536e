#pragma once

#include <string>

#include "diagnosis/diagnosis.h"

namespace vibrissa::diagnosis {

/// The answer as records.md fixes it, schema "vibrissa-diagnosis-1", with findings, guesses,
/// untested effects, the gap map and probability_of_unlisted added. Numbers that are not finite
/// become null. Proven by tests/diagnosis/diagnosis_json_test.cc.
std::string diagnosis_json(const Diagnosis& diagnosis);

/// At most 15 lines of at most 100 characters for a terminal.
std::string verdict_text(const Diagnosis& diagnosis);

}  // namespace vibrissa::diagnosis
