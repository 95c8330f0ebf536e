#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vibrissa::report {

/// Result of drawing the pictures of a run folder.
struct PictureReport {
  std::vector<std::filesystem::path> made;  // relative to the run folder
  std::vector<std::string> problems;        // one line for each figure that could not be drawn
  std::string message;                      // one line for the user: what was drawn, and what not
  std::string chatter;                      // all output of the process for scenes, when it failed
};

struct PictureOptions {
  /// Program that calls draw_scenes() for the arguments "draw FOLDER --scenes".
  std::filesystem::path program;
  double time_limit_s = 120.;
};

/// Draws FOLDER/figures/NAME.json (figure.h) to NAME.png, NAME.svg and NAME.pdf beside them, and
/// NAME.scene.json (mode_picture.h) to NAME.png: these in a child process, because VTK aborts when
/// it cannot open a display; on the current display, without one, or when this fails, on a virtual
/// one by xvfb-run. Never throws for lack of a display. Proven by
/// tests/report/files/pictures_test.cc.
PictureReport draw_pictures(const std::filesystem::path& folder, const PictureOptions& options);

}  // namespace vibrissa::report
