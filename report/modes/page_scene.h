#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "report/figures/mode_picture.h"
#include "report/figures/packed_numbers.h"

namespace vibrissa::report {

/// The surface of a picture for the page's script: title, caption, and as indices of lists in
/// numbers "points" (at rest), "moves" (displacement times its scale), "triangles" (three points
/// each), "values" (shown as colours, per point or, with "of_cells", per triangle), "outline" (two
/// points each, coordinates); "colours" from the lower to the upper end of "range". Single
/// precision. Throws UserError like read_deformed_mesh(). Proven by
/// tests/report/modes/page_scene_test.cc.
nlohmann::json page_scene(const std::filesystem::path& folder, const ModePicture& picture,
                          PackedNumbers& numbers);

}  // namespace vibrissa::report
