#pragma once

#include "report/figures/envelope.h"

namespace vibrissa::report {

/// The line cut into dashes of length on with spaces of length off, measured along the line and
/// restarted after each gap. Implemented here because VTK's patterns do not scale with a picture.
/// Proven by tests/report/drawing/dashes_test.cc.
Polyline dashes(const Polyline& line, double on, double off);

}  // namespace vibrissa::report
