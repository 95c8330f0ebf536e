#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "report/figures/figure.h"
#include "report/figures/mode_picture.h"
#include "report/figures/packed_numbers.h"
#include "report/figures/table.h"

namespace vibrissa::report {

/// A main result of the page.
struct KeyNumber {
  std::string label{};
  std::string value{};  // with its unit
  std::string note{};   // interval or reference value
};

struct PageTable {
  std::string name{};  // name of the CSV file, without extension
  std::string caption{};
  Table table;
  bool folded = false;  // the reader must open it
};

struct PageSection {
  std::string heading{};
  std::vector<std::string> text{};  // paragraphs
  std::vector<PageTable> tables{};
  std::vector<Figure> figures{};
  std::vector<ModePicture> scenes{};  // shown in one view; the reader chooses from a list
};

/// Content of report.html of a run folder.
struct Page {
  std::string title{};
  std::string headline{};              // the verdict in one sentence
  std::vector<std::string> verdict{};  // further paragraphs
  std::vector<KeyNumber> numbers{};
  std::vector<PageSection> sections{};
};

/// The surface of a picture for the page's script (page_scene.h); a page with scenes needs it.
using SceneReader = std::function<nlohmann::json(
    const std::filesystem::path& folder, const ModePicture& picture, PackedNumbers& numbers)>;

/// One HTML document that needs no network and no other files: text, tables, interactive figures
/// and surfaces, with the command line from the folder's run.json. folder: the run folder with
/// run.json, the meshes of the scenes and figures/NAME.png (shown instead of a scene without
/// WebGL). Missing files are left out, except meshes. Throws UserError like check() and
/// scene_of. Proven by tests/report/page/page_test.cc and tests/report/browser.
std::string to_html(const Page& page, const std::filesystem::path& folder,
                    const SceneReader& scene_of = {});

/// Writes FOLDER/report.html.
void write_page(const std::filesystem::path& folder, const Page& page,
                const SceneReader& scene_of = {});

}  // namespace vibrissa::report
