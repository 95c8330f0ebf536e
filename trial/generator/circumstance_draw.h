#pragma once

#include <cstdint>

#include "trial/classes/case_class.h"
#include "trial/classes/circumstances.h"

namespace vibrissa::trial {

/// The circumstances of the case with this number. Every value of each circumstance comes once in a
/// shuffled block of as many cases as it has values. They have a seed stream of their own. A sensor
/// that is off in its calibrations alone is never at distance exact; a wrong log needs a log, which
/// two files do not have; a model is the exact simulation, so its form error is 0, and it never
/// comes with two files. Proven by tests/trial/generator/circumstance_draw_test.cc.
Circumstances draw_circumstances(std::uint64_t seed, std::size_t number, CaseClass kind);

/// Seed of a stream for one purpose of one case.
std::uint64_t stream_seed(std::uint64_t seed, std::size_t number, std::uint32_t purpose);

}  // namespace vibrissa::trial
