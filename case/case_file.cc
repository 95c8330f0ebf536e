#include "case/case_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "case/case_entries.h"
#include "case/embedded_cases.h"
#include "signals/base/error.h"

namespace vibrissa::sensor_case {

namespace {

using signals::UserError;

std::string trimmed(const std::string& text) {
  return dealii::Utilities::trim(text);
}

std::vector<std::string> lines_of(std::istream& in) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The built-in case of this name, for those who are in another folder than the one with cases/.
std::optional<std::string_view> built_in_case(const std::filesystem::path& file) {
  if (!file.parent_path().empty() && file.parent_path() != "cases") return std::nullopt;
  if (file.filename() == "flow_sensor.prm") return flow_sensor_case();
  if (file.filename() == "whisker_sensor.prm") return whisker_sensor_case();
  return std::nullopt;
}

std::vector<std::string> read_lines(const std::filesystem::path& file) {
  const auto built_in = built_in_case(file);
  if (built_in && !std::filesystem::exists(file)) {
    std::istringstream in{std::string(*built_in)};
    return lines_of(in);
  }
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) {
    throw UserError(file.string() +
                    ": cannot be read; name an existing case file (.prm), or the built-in "
                    "cases/flow_sensor.prm or cases/whisker_sensor.prm");
  }
  return lines_of(in);
}

std::optional<std::string> text_after(const std::string& line, const std::string& keyword) {
  const std::string text = trimmed(line);
  if (text.rfind(keyword + " ", 0) != 0) return std::nullopt;
  return trimmed(text.substr(keyword.size()));
}

std::string entry_name(const std::string& assignment) {
  return trimmed(assignment.substr(0, assignment.find('=')));
}

std::string join(const std::vector<std::string>& parts) {
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : "/") + part;
  return text;
}

/// Declared names, from deal.II's plain listing: its JSON has mangled keys.
class DeclaredNames {
 public:
  explicit DeclaredNames(const dealii::ParameterHandler& prm) {
    std::ostringstream text;
    prm.print_parameters(text, dealii::ParameterHandler::ShortText);
    listing_ = text.str();
  }

  /// keyword: set or subsection. Throws UserError, which begins with where the name was given.
  void check(const std::string& given_at, const std::vector<std::string>& sections,
             const std::string& keyword, const std::string& name) const {
    const std::vector<std::string> known = of(sections, keyword);
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    const std::string kind = keyword == "set" ? "entry" : "subsection";
    const std::string where = sections.empty() ? "" : " in subsection '" + join(sections) + "'";
    throw UserError(given_at + ": " + signals::unknown_name(kind + where, name, known));
  }

 private:
  std::vector<std::string> of(const std::vector<std::string>& sections,
                              const std::string& keyword) const {
    std::vector<std::string> names, path;
    std::istringstream in(listing_);
    for (std::string line; std::getline(in, line);) {
      if (const auto section = text_after(line, "subsection")) {
        if (keyword == "subsection" && path == sections) names.push_back(*section);
        path.push_back(*section);
      } else if (trimmed(line) == "end") {
        path.pop_back();
      } else if (const auto entry = text_after(line, "set"); entry && keyword == "set") {
        if (path == sections) names.push_back(entry_name(*entry));
      }
    }
    return names;
  }

  std::string listing_;
};

// Finds names that are not declared before deal.II does, whose message lists no known ones.
void check_names(const std::filesystem::path& file, const std::vector<std::string>& lines,
                 const dealii::ParameterHandler& prm) {
  const DeclaredNames declared(prm);
  std::vector<std::string> sections;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string here = file.string() + ":" + std::to_string(i + 1);
    if (const auto section = text_after(lines[i], "subsection")) {
      declared.check(here, sections, "subsection", *section);
      sections.push_back(*section);
    } else if (trimmed(lines[i]) == "end" && !sections.empty()) {
      sections.pop_back();
    } else if (const auto entry = text_after(lines[i], "set")) {
      declared.check(here, sections, "set", entry_name(*entry));
    }
  }
}

std::string plain_text(const dealii::ExceptionBase& error) {
  std::ostringstream text;
  error.print_info(text);
  return dealii::Utilities::replace_in_string(trimmed(text.str()), "\n", " ");
}

// " (line 12: Wire diameter)" for every entry of the file that a message names.
std::string lines_of_named_entries(const std::vector<std::string>& lines,
                                   const std::string& message) {
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto entry = text_after(lines[i], "set");
    if (!entry || message.find(entry_name(*entry)) == std::string::npos) continue;
    text +=
        (text.empty() ? " (line " : ", line ") + std::to_string(i + 1) + ": " + entry_name(*entry);
  }
  return text.empty() ? "" : text + ")";
}

}  // namespace

CaseFile::CaseFile(const std::filesystem::path& file)
    : file_(file), prm_(std::make_unique<dealii::ParameterHandler>()) {
  declare_case(*prm_);
  const auto lines = read_lines(file);
  check_names(file, lines, *prm_);
  std::ostringstream text;
  for (const auto& line : lines) text << line << "\n";
  std::istringstream in(text.str());
  try {
    prm_->parse_input(in, file.string(), "", false);
  } catch (const dealii::ExceptionBase& error) {
    throw UserError(file.string() + ": " + plain_text(error));
  }
}

CaseFile::~CaseFile() = default;
CaseFile::CaseFile(CaseFile&&) noexcept = default;

void CaseFile::set(const std::string& section, const std::string& entry, const std::string& value,
                   const std::string& option) {
  const DeclaredNames declared(*prm_);
  const std::string given_at = "option " + option;
  std::vector<std::string> path;
  for (const auto& name : dealii::Utilities::split_string_list(section, '/')) {
    declared.check(given_at, path, "subsection", name);
    path.push_back(name);
  }
  declared.check(given_at, path, "set", entry);
  for (const auto& name : path) prm_->enter_subsection(name);
  try {
    prm_->set(entry, value);
  } catch (const dealii::ExceptionBase& error) {
    throw UserError(given_at + " (" + section + "/" + entry + "): " + plain_text(error));
  }
  for (std::size_t i = 0; i < path.size(); ++i) prm_->leave_subsection();
}

std::string CaseFile::get(const std::string& section, const std::string& entry) const {
  return prm_->get(dealii::Utilities::split_string_list(section, '/'), entry);
}

Case CaseFile::read() {
  try {
    return parse_case(*prm_);
  } catch (const UserError& error) {
    throw UserError(file_.string() + ": " + error.what() +
                    lines_of_named_entries(read_lines(file_), error.what()));
  }
}

std::string CaseFile::resolved() const {
  std::ostringstream text;
  prm_->print_parameters(
      text, dealii::ParameterHandler::Text | dealii::ParameterHandler::KeepDeclarationOrder);
  return text.str();
}

}  // namespace vibrissa::sensor_case
