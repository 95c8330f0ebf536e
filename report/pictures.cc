#include "report/pictures.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <system_error>

#include "report/drawing/draw.h"
#include "report/figures/figure.h"
#include "report/files/child_process.h"
#include "report/files/picture_lines.h"

namespace vibrissa::report {
namespace {

namespace fs = std::filesystem;

bool has_display() {
  const char* display = std::getenv("DISPLAY");
  return display && *display != '\0';
}

/// Sorted names in FOLDER/figures.
std::vector<std::string> requests(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code no_folder;
  for (const auto& entry : fs::directory_iterator(folder / "figures", no_folder))
    if (entry.path().extension() == ".json") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

bool is_scene(const std::string& name) {
  return name.ends_with(scene_ending);
}

void draw_figure(const fs::path& folder, const std::string& name, PictureReport& report) {
  try {
    const Figure figure = read_figure(folder / "figures" / name);
    const Picture picture = picture_of(figure);
    for (const char* ending : {".pdf", ".png", ".svg"}) {
      const fs::path made = (fs::path("figures") / name).replace_extension(ending);
      write_picture(picture, folder / made);
      report.made.push_back(made);
    }
  } catch (const std::exception& error) {
    report.problems.emplace_back(error.what());
    std::ranges::replace(report.problems.back(), '\n', ' ');
  }
}

/// Takes the child's lines. Returns whether the child finished.
bool read_lines(const std::string& output, PictureReport& report) {
  bool done = false;
  const std::string made = made_line, problem = problem_line;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(made)) report.made.emplace_back(line.substr(made.size()));
    if (line.starts_with(problem)) report.problems.push_back(line.substr(problem.size()));
    done |= line == last_line;
  }
  return done;
}

std::string last_words(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return last;
}

struct Attempt {
  std::string name;  // for messages
  std::vector<std::string> command;
};

std::vector<Attempt> attempts(const fs::path& folder, const PictureOptions& options) {
  const std::vector<std::string> command = {options.program.string(), "draw", folder.string(),
                                            "--scenes"};
  std::vector<Attempt> list;
  if (has_display()) list.push_back({"drawing on the display", command});
  const std::string xvfb_run = find_program("xvfb-run");
  if (!xvfb_run.empty()) {
    list.push_back({"drawing by xvfb-run", {xvfb_run, "-a", "-s", "-screen 0 1280x1024x24"}});
    list.back().command.insert(list.back().command.end(), command.begin(), command.end());
  }
  return list;
}

/// Returns why there are none; empty when there are.
std::string draw_scenes_by_child(const fs::path& folder, const PictureOptions& options,
                                 PictureReport& report) {
  const auto ways = attempts(folder, options);
  if (ways.empty()) return "there is no display and no xvfb-run; install the package xvfb";
  std::string reasons;
  for (const Attempt& way : ways) {
    const ChildResult child = run_child(way.command, options.time_limit_s);
    PictureReport scenes;
    const bool done = read_lines(child.output, scenes);
    if (!child.succeeded()) report.chatter += child.output;
    if (done || &way == &ways.back()) {
      report.made.insert(report.made.end(), scenes.made.begin(), scenes.made.end());
      report.problems.insert(report.problems.end(), scenes.problems.begin(), scenes.problems.end());
    }
    if (done) {
      if (scenes.problems.empty()) report.chatter.clear();
      return {};
    }
    reasons += (reasons.empty() ? "" : "; ") + way.name + " " + child.what_happened();
    const std::string words = last_words(child.output);
    if (!words.empty()) reasons += " (" + words + ")";
  }
  return reasons;
}

}  // namespace

PictureReport draw_pictures(const fs::path& folder, const PictureOptions& options) {
  PictureReport report;
  const std::vector<std::string> names = requests(folder);
  if (names.empty()) {
    report.message = "no figures to draw in " + (folder / "figures").string();
    return report;
  }
  for (const std::string& name : names)
    if (!is_scene(name)) draw_figure(folder, name, report);
  if (std::ranges::any_of(names, is_scene)) {
    const std::string reason = draw_scenes_by_child(folder, options, report);
    if (!reason.empty())
      report.problems.push_back("shapes in 3-D, which need a display: " + reason);
  }
  const std::size_t n = report.made.size();
  report.message = std::to_string(n) + (n == 1 ? " picture" : " pictures") + " drawn in " +
                   (folder / "figures").string();
  for (const auto& problem : report.problems) report.message += "; not drawn: " + problem;
  return report;
}

}  // namespace vibrissa::report
