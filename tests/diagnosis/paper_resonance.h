#pragma once

#include "diagnosis/resonances/resonance_gap.h"

namespace vibrissa::diagnosis::test {

/// The reference study's own gap of resonances, explained.
inline ResonanceDiagnosis paper() {
  const ResonanceExample example = paper_gap();
  return explain_resonance_gap(example.simulated, example.measured, example.model);
}

}  // namespace vibrissa::diagnosis::test
