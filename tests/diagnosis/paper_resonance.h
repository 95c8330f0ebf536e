#pragma once

#include "diagnosis/resonances/resonance_gap.h"

namespace vibrissa::diagnosis::test {

/// Explanations of the reference study's resonance gap.
inline ResonanceDiagnosis paper() {
  const ResonanceExample example = paper_gap();
  return explain_resonance_gap(example.simulated, example.measured, example.model);
}

}  // namespace vibrissa::diagnosis::test
