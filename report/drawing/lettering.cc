#include "report/drawing/lettering.h"

#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <array>
#include <filesystem>
#include <utility>

namespace vibrissa::report {
namespace {

constexpr const char* regular_font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* bold_font = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";

bool has_dejavu() {
  static const bool both =
      std::filesystem::exists(regular_font) && std::filesystem::exists(bold_font);
  return both;
}

constexpr std::array<std::pair<const char*, char>, 11> superscripts = {{{"\u2070", '0'},
                                                                        {"\u00b9", '1'},
                                                                        {"\u00b2", '2'},
                                                                        {"\u00b3", '3'},
                                                                        {"\u2074", '4'},
                                                                        {"\u2075", '5'},
                                                                        {"\u2076", '6'},
                                                                        {"\u2077", '7'},
                                                                        {"\u2078", '8'},
                                                                        {"\u2079", '9'},
                                                                        {"\u207b", '-'}}};

}  // namespace

void set_lettering(vtkTextProperty& property, const int size, const bool bold) {
  property.SetFontSize(size);
  property.SetColor(0.1, 0.1, 0.1);
  property.SetItalic(0);
  property.SetShadow(0);
  if (has_dejavu()) {
    property.SetFontFamily(VTK_FONT_FILE);
    property.SetFontFile(bold ? bold_font : regular_font);
    property.SetBold(0);
  } else {
    property.SetFontFamilyToArial();
    property.SetBold(bold ? 1 : 0);
  }
}

std::string without_superscripts(const std::string& text) {
  std::string plain;
  bool raised = false;
  for (std::size_t i = 0; i < text.size();) {
    const auto* found = superscripts.begin();
    while (found != superscripts.end() &&
           text.compare(i, std::string(found->first).size(), found->first) != 0)
      ++found;
    if (found == superscripts.end()) {
      raised = false;
      plain += text[i++];
      continue;
    }
    if (!raised) plain += '^';
    raised = true;
    plain += found->second;
    i += std::string(found->first).size();
  }
  return plain;
}

std::string printable(const std::string& text) {
  return has_dejavu() ? text : without_superscripts(text);
}

double text_width(const std::string& text, const int size, const bool bold) {
  constexpr int dots_per_inch = 72;  // one pixel per point
  if (text.empty()) return 0.;
  vtkNew<vtkTextProperty> property;
  set_lettering(*property, size, bold);
  int box[4] = {};
  vtkTextRenderer::GetInstance()->GetBoundingBox(property.Get(), vtkStdString(printable(text)), box,
                                                 dots_per_inch);
  return box[1] - box[0] + 1.;
}

}  // namespace vibrissa::report
