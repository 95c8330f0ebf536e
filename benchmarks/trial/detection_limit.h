#pragma once

#include <cstdint>
#include <optional>

#include "benchmarks/trial/session.h"
#include "benchmarks/trial/unknowns.h"

namespace vibrissa::trial {

/// Solved structures are kept: few worlds differ in their solid.
const Structure& structure_of(const SolidChange& change);

/// Non-centrality of the likelihood-ratio test that knows the form of what world adds to plain:
/// change of the moment that the measured base motion does not foretell, over the noise of both
/// channels, in the fit takes. Noise is taken as white.
double noncentrality(const World& plain, const World& world, const Session& session, bool random);

/// Size at which that test finds an unknown in half of all cases at one false alarm in a hundred
/// (non-centrality 6.63 for one parameter). Nothing where even the largest stays below. Proven by
/// tests/benchmarks/trial/detection_limit_test.cc.
std::optional<double> detection_limit(const World& plain, const Unknown& unknown, double sign,
                                      double shape, const Session& session);

}  // namespace vibrissa::trial
