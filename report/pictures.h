#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vibrissa::report {

/// What became of the pictures of a run folder.
struct PictureReport {
  std::vector<std::filesystem::path> made;  // relative to the run folder
  std::vector<std::string> problems;        // a line for each figure that could not be drawn
  std::string message;                      // one line for the user: what was made, or why nothing
  std::string chatter;                      // all that the drawing process said, when it failed
};

struct PictureOptions {
  /// Program that calls draw_folder() for the arguments "draw FOLDER"; by default the one running.
  std::filesystem::path program = "/proc/self/exe";
  double time_limit_s = 120.;
};

/// Draws FOLDER/figures/NAME.json (figure.h) and NAME.scene.json (mode_picture.h) to NAME.png and
/// NAME.svg beside them (scenes to PNG alone), in a child process because VTK aborts when it cannot
/// open a display: on the display at hand, else, or when that fails, on a virtual one by xvfb-run.
/// Never throws for want of a display: the CSV files beside the figures hold the same data. Proven
/// by tests/report/files/pictures_test.cc.
PictureReport draw_pictures(const std::filesystem::path& folder,
                            const PictureOptions& options = {});

/// What the child does: draws all it can and prints a line for each picture and each problem. For
/// use by hand it falls back on draw_pictures() where DISPLAY is not set. Returns the exit status:
/// 0 when everything was drawn, else 1.
int draw_folder(const std::filesystem::path& folder);

}  // namespace vibrissa::report
