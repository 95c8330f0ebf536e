#include "report/modes/draw_scenes.h"

#include <sys/resource.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>

#include <algorithm>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "report/figures/mode_picture.h"
#include "report/files/picture_lines.h"
#include "report/modes/draw_mode.h"
#include "signals/base/error.h"

namespace vibrissa::report {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> scenes_of(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code no_folder;
  for (const auto& entry : fs::directory_iterator(folder / "figures", no_folder))
    if (entry.path().filename().string().ends_with(scene_ending)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

bool draw_scenes(const fs::path& folder) {
  // VTK aborts without a display; the abort must not leave a core file in the user's folder.
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  // A virtual display restarts when its last window closes, and may then miss the next window.
  vtkNew<vtkRenderWindow> window;
  prepare_offscreen(*window, 1, 1);
  window->Render();
  bool all = true;
  for (const fs::path& scene : scenes_of(folder)) {
    const fs::path made = fs::path("figures") / scene.stem().replace_extension(".png");
    try {
      if (fs::exists((folder / made).replace_extension(".json")))
        throw signals::UserError("figures/" + scene.filename().string() +
                                 ": a figure has the same picture name " +
                                 made.filename().string() + "; rename one of them");
      draw_mode(read_mode_picture(scene), folder, folder / made);
      std::cout << made_line << made.string() << std::endl;
    } catch (const std::exception& error) {
      all = false;
      std::cout << problem_line << one_line(error.what()) << std::endl;
    }
  }
  std::cout << last_line << std::endl;
  return all;
}

}  // namespace vibrissa::report
