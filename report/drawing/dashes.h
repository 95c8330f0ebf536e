#pragma once

#include "report/figures/envelope.h"

namespace vibrissa::report {

/// The line cut into dashes of length on with spaces of length off, measured along it and starting
/// anew after each gap. Our own, because VTK's patterns do not grow with a picture. Proven by
/// tests/report/drawing/dashes_test.cc.
Polyline dashes(const Polyline& line, double on, double off);

}  // namespace vibrissa::report
