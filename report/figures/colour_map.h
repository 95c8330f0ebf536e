#pragma once

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include "report/figures/range.h"

namespace vibrissa::report {

/// Colours for values in the range: from dark to bright with even steps for the eye (viridis), or,
/// where the range has values of both signs, from blue over white at 0 to red.
vtkSmartPointer<vtkLookupTable> colour_map(const Range& values);

/// The range that colour_map() covers: symmetric when the range has both signs, and never of length
/// 0.
Range colour_range(const Range& values);

}  // namespace vibrissa::report
