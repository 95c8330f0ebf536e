#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "diagnosis/resonances/resonance_gap.h"

namespace vibrissa::diagnosis {

/// Schema "vibrissa-resonance-gap-1": both resonances; every explanation with its values, odds,
/// remaining damping ratio and note; confidence set; next experiment. Proven by
/// tests/diagnosis/resonances/resonance_gap_text_test.cc.
nlohmann::ordered_json resonance_gap_json(const ResonanceDiagnosis& diagnosis);

/// At most 20 lines of at most 100 characters for a terminal: every single effect with the value
/// that it needs, the most probable combinations, effects that are impossible alone, the next
/// experiment.
std::string resonance_gap_text(const ResonanceDiagnosis& diagnosis);

}  // namespace vibrissa::diagnosis
