#pragma once

#include <string>

#include "diagnosis/diagnosis.h"

namespace vibrissa::diagnosis {

/// The answer as docs/records.md fixes it, schema "vibrissa-diagnosis-1", with findings, guesses,
/// untested effects, the gap map, probability_of_unlisted, probability_of_tried and
/// probability_of_outside added. Numbers that are not finite become null. Proven by
/// tests/diagnosis/diagnosis_json_test.cc.
std::string diagnosis_json(const Diagnosis& diagnosis);

/// Does the answer name mere parameter errors, so that the simulation wants recalibration and no
/// new physics? False for "none" and "outside_catalogue".
bool is_recalibration(const std::string& answer);

/// Lines of at most 100 characters, for a terminal no more than 15: what does not fit as a whole is
/// left out.
std::string verdict_text(const Diagnosis& diagnosis, std::size_t most_lines = 15);

}  // namespace vibrissa::diagnosis
