#pragma once

namespace vibrissa::report {

/// The lines by which the program that draws scenes reports to the one that started it.
inline constexpr const char *made_line = "drawn: ", *problem_line = "not drawn: ",
                            *last_line = "all scenes done";

/// Ending of the requests for scenes in FOLDER/figures.
inline constexpr const char* scene_ending = ".scene.json";

}  // namespace vibrissa::report
