#pragma once

#include <string>

#include "diagnosis/diagnosis.h"

namespace vibrissa::diagnosis {

/// Does the answer name parameter errors only, so that the simulation needs recalibration and no
/// new physics? False for "none" and "outside_catalogue".
bool is_recalibration(const std::string& answer);

/// What an answer that names effects means for the simulation, without a full stop: "The simulation
/// needs recalibration: set stiffness to 1.21 times the simulated value" or "The simulation lacks
/// backlash".
std::string consequence(const Diagnosis& diagnosis);

/// Terms that describe what no known effect explains, as a sentence without a full stop; empty
/// where there are none to describe.
std::string unknown_sentence(const Diagnosis& diagnosis);

/// The diagnosis as docs/records.md describes it, schema "vibrissa-diagnosis-2". Numbers that are
/// not finite become null. Proven by tests/diagnosis/diagnosis_json_test.cc.
std::string diagnosis_json(const Diagnosis& diagnosis);

/// Lines of at most 100 characters, at most 24 lines for a terminal: entries that do not fit
/// completely are left out.
std::string verdict_text(const Diagnosis& diagnosis, std::size_t most_lines = 24);

}  // namespace vibrissa::diagnosis
