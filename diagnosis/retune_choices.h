#pragma once

#include <string>
#include <vector>

#include "diagnosis/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Evidence of every set of nuisances that may differ from nominal, the others nominal, best first:
/// by Savage's and Dickey's ratio from the posterior with all of them free. A shift within what the
/// nominal form misses of the simulation, or within what form errors of the effects may bring,
/// counts as nominal.
std::vector<RetuneChoice> retune_choices(const NominalModel& nominal, const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
