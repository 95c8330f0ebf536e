#include "report/pictures.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>
#include <system_error>

#include "report/drawing/draw.h"
#include "report/drawing/picture_file.h"
#include "report/figures/figure.h"
#include "report/files/child_process.h"
#include "report/modes/draw_mode.h"
#include "report/modes/mode_picture.h"
#include "signals/base/error.h"

namespace vibrissa::report {
namespace {

namespace fs = std::filesystem;

// Prefixes of the lines by which the child reports to its parent.
const std::string made_line = "drawn: ", problem_line = "not drawn: ",
                  last_line = "all figures done";

constexpr const char* scene_ending = ".scene.json";
constexpr const char* csv_only = "figures are available as CSV only";

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

/// Draws one request; returns the pictures.
std::vector<fs::path> draw(const fs::path& folder, const std::string& name) {
  const fs::path figures = "figures";
  if (!name.ends_with(scene_ending)) {
    const auto stem = (figures / name).replace_extension();
    const std::vector<fs::path> made = {stem.string() + ".png", stem.string() + ".svg"};
    draw_figure(read_figure(folder / figures / name), folder / made[0], folder / made[1]);
    return made;
  }
  const std::string stem = name.substr(0, name.size() - std::string(scene_ending).size());
  if (fs::exists(folder / figures / (stem + ".json")))
    throw signals::UserError("figures/" + name + ": " + stem + ".json uses the same picture name " +
                             stem + ".png; rename one of them");
  const fs::path made = figures / (stem + ".png");
  draw_mode(read_mode_picture(folder / figures / name), folder, folder / made);
  return {made};
}

/// Fills made and problems from the child's lines. Returns whether the child finished.
bool read_lines(const std::string& output, PictureReport& report) {
  bool done = false;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(made_line)) report.made.emplace_back(line.substr(made_line.size()));
    if (line.starts_with(problem_line)) report.problems.push_back(line.substr(problem_line.size()));
    done |= line == last_line;
  }
  return done;
}

std::string one_line(const std::string& text) {
  std::string line = text;
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

std::string last_words(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  return last;
}

std::string summary(const PictureReport& report, const fs::path& folder) {
  const std::size_t n = report.made.size();
  std::string text = std::to_string(n) + (n == 1 ? " picture" : " pictures") + " drawn in " +
                     (folder / "figures").string();
  for (const auto& problem : report.problems) text += "; not drawn: " + problem;
  return text;
}

struct Attempt {
  std::string name;  // for messages
  std::vector<std::string> command;
};

std::vector<Attempt> attempts(const fs::path& folder, const PictureOptions& options) {
  // Inside xvfb-run /proc/self/exe would be the shell.
  std::error_code no_link;
  const fs::path target = fs::read_symlink(options.program, no_link);
  const fs::path program = no_link ? options.program : target;
  const std::vector<std::string> command = {program.string(), "draw", folder.string()};
  std::vector<Attempt> list;
  if (has_display()) list.push_back({"drawing on the display", command});
  const std::string xvfb_run = find_program("xvfb-run");
  if (!xvfb_run.empty()) {
    list.push_back({"drawing by xvfb-run", {xvfb_run, "-a", "-s", "-screen 0 1280x1024x24"}});
    list.back().command.insert(list.back().command.end(), command.begin(), command.end());
  }
  return list;
}

}  // namespace

PictureReport draw_pictures(const fs::path& folder, const PictureOptions& options) {
  PictureReport report;
  if (requests(folder).empty()) {
    report.message = "no figures to draw in " + (folder / "figures").string();
    return report;
  }
  const auto ways = attempts(folder, options);
  if (ways.empty()) {
    report.message = std::string("there is no display and no xvfb-run: ") + csv_only +
                     "; install the package xvfb";
    return report;
  }
  std::string reasons, chatter;
  for (const Attempt& way : ways) {
    const ChildResult child = run_child(way.command, options.time_limit_s);
    report.made.clear();
    report.problems.clear();
    const bool done = read_lines(child.output, report);
    if (!child.succeeded()) chatter += child.output;
    if (done) {
      report.message = summary(report, folder);
      if (!report.problems.empty()) report.chatter = chatter;
      return report;
    }
    reasons += (reasons.empty() ? "" : "; ") + way.name + " " + child.what_happened();
    const std::string words = last_words(child.output);
    if (!words.empty()) reasons += " (" + words + ")";
  }
  report.message = (report.made.empty() ? csv_only : summary(report, folder) + ", then failure") +
                   (": " + reasons);
  report.chatter = chatter;
  return report;
}

int draw_folder(const fs::path& folder) {
  if (!has_display() || requests(folder).empty()) {
    const PictureReport report = draw_pictures(folder);
    std::cout << report.message << std::endl;
    return report.made.empty() || !report.problems.empty() ? 1 : 0;
  }
  // VTK aborts without a display; the abort must not leave a core file in the user's folder.
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const OpenDisplay display;
  bool all = true;
  for (const std::string& name : requests(folder)) {
    try {
      for (const fs::path& picture : draw(folder, name))
        std::cout << made_line << picture.string() << std::endl;
    } catch (const std::exception& error) {
      all = false;
      std::cout << problem_line << one_line(error.what()) << std::endl;
    }
  }
  std::cout << last_line << std::endl;
  return all ? 0 : 1;
}

}  // namespace vibrissa::report
