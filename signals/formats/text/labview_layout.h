#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "signals/formats/text/table_layout.h"

namespace vibrissa::signals::formats {

/// Whether the first line is that of a LabVIEW measurement file (.lvm).
bool is_labview(const std::vector<HeadLine>& head);

/// The layout that the headers of a LabVIEW measurement file state: separator, decimal mark,
/// columns of x (none, one, or one for each channel), units, rates, samples of a block. Delta_X is
/// rounded: the rate is the one with the fewest digits that it allows. Throws UserError with the
/// line for a file without names (X_Value). Proven by
/// tests/signals/formats/labview_file_test.cc.
TableLayout labview_layout(const std::string& file, const std::vector<HeadLine>& head,
                           const TextOptions& options);

/// Whether a line begins the header of a further block, and whether it is the last one of a header.
bool begins_labview_header(std::string_view line);
bool ends_labview_header(std::string_view line);

}  // namespace vibrissa::signals::formats
