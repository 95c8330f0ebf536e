#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vibrissa::report {

/// Result of drawing the pictures of a run folder.
struct PictureReport {
  std::vector<std::filesystem::path> made;  // relative to the run folder
  std::vector<std::string> problems;        // one line for each figure that could not be drawn
  std::string message;  // one line for the user: what was drawn, or why nothing was drawn
  std::string chatter;  // all output of the drawing process, when it failed
};

struct PictureOptions {
  /// Program that calls draw_folder() for the arguments "draw FOLDER"; default: the running
  /// program.
  std::filesystem::path program = "/proc/self/exe";
  double time_limit_s = 120.;
};

/// Draws FOLDER/figures/NAME.json (figure.h) and NAME.scene.json (mode_picture.h) to NAME.png and
/// NAME.svg beside them (scenes to PNG alone), in a child process, because VTK aborts when it
/// cannot open a display. Uses the current display; without one, or when this fails, a virtual
/// display by xvfb-run. Never throws for lack of a display: the CSV files beside the figures hold
/// the same data. Proven by tests/report/files/pictures_test.cc.
PictureReport draw_pictures(const std::filesystem::path& folder,
                            const PictureOptions& options = {});

/// Work of the child process: draws all possible pictures and prints one line for each picture and
/// each problem. When a user calls it without DISPLAY, it calls draw_pictures(). Returns the exit
/// status: 0 when everything was drawn, else 1.
int draw_folder(const std::filesystem::path& folder);

}  // namespace vibrissa::report
