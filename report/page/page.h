#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/figures/figure.h"
#include "report/figures/table.h"
#include "report/modes/mode_picture.h"

namespace vibrissa::report {

/// A number that a reader should take away.
struct KeyNumber {
  std::string label{};
  std::string value{};  // with its unit
  std::string note{};   // interval, or beside what it stands
};

struct PageTable {
  std::string name{};  // of the CSV file, without extension
  std::string caption{};
  Table table;
  bool folded = false;  // to be opened by those who want it
};

struct PageSection {
  std::string heading{};
  std::vector<std::string> text{};  // paragraphs
  std::vector<PageTable> tables{};
  std::vector<Figure> figures{};
  std::vector<ModePicture> scenes{};  // shown in one view, chosen from a list
};

/// What report.html of a run folder says: the verdict first.
struct Page {
  std::string title{};
  std::string headline{};              // the verdict in one sentence
  std::vector<std::string> verdict{};  // more of it, a paragraph each
  std::vector<KeyNumber> numbers{};
  std::vector<PageSection> sections{};
};

/// One document that asks nothing of a network or of other files: text, tables, interactive figures
/// and surfaces, with the command line of the folder's run.json. folder: the run folder, for
/// run.json, the meshes of the scenes and figures/NAME.png, which stands in for a scene where there
/// is no WebGL; of these, what is missing is left out, but a mesh. What it says depends on nothing
/// else. Throws UserError as check() and read_deformed_mesh() do. Proven by
/// tests/report/page/page_test.cc and tests/report/browser.
std::string to_html(const Page& page, const std::filesystem::path& folder);

/// Writes FOLDER/report.html.
void write_page(const std::filesystem::path& folder, const Page& page);

}  // namespace vibrissa::report
