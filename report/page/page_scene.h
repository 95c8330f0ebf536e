#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "report/figures/packed_numbers.h"
#include "report/modes/mode_picture.h"

namespace vibrissa::report {

/// The surface that a picture names, for the page's script: title, caption, and as numbers of lists
/// "points" (at rest), "moves" (displacement times its scale), "triangles" (three points each),
/// "values" (to be shown as colours, of points or, with "of_cells", of triangles), "outline" (two
/// points each, coordinates); "colours" from the least to the most of "range". Single precision.
/// Throws UserError as read_deformed_mesh(). Proven by tests/report/page/page_scene_test.cc.
nlohmann::json page_scene(const std::filesystem::path& folder, const ModePicture& picture,
                          PackedNumbers& numbers);

}  // namespace vibrissa::report
