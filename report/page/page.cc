#include "report/page/page.h"

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "report/figures/palette.h"
#include "report/page/page_assets.h"
#include "report/page/page_figure.h"
#include "report/page/page_origin.h"
#include "report/text/base64.h"
#include "report/text/html_text.h"
#include "signals/system/output_file.h"

namespace vibrissa::report {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string paragraphs(const std::vector<std::string>& texts) {
  std::string html;
  for (const std::string& text : texts) html += html_element("p", text);
  return html;
}

std::string inlined_picture(const fs::path& png, const std::string& title) {
  std::ifstream in(png, std::ios::binary);
  if (!in) return "";
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  return "<img alt=\"" + html_escaped(title) + "\" src=\"data:image/png;base64," +
         base64(std::as_bytes(std::span(bytes))) + "\">\n";
}

/// Builds the body of the page, and collects the data that its elements need for the script.
class Body {
 public:
  Body(const fs::path& folder, const SceneReader& scene_of) : folder_(folder), scene_of_(scene_of) {
    for (const Colour& colour : palette) data_["palette"].push_back(colour);
  }

  std::string section(const PageSection& section) {
    const std::string id = "section-" + std::to_string(++n_sections_);
    std::string html = "<section aria-labelledby=\"" + id + "\">\n<h2 id=\"" + id + "\">" +
                       html_escaped(section.heading) + "</h2>\n" + paragraphs(section.text);
    contents_ += "<li><a href=\"#" + id + "\">" + html_escaped(section.heading) + "</a></li>\n";
    for (const PageTable& table : section.tables) html += table_element(table);
    for (const Figure& figure : section.figures) html += figure_element(figure);
    if (!section.scenes.empty()) html += view_element(section.scenes);
    return html + "</section>\n";
  }

  const std::string& contents() const { return contents_; }
  bool has_scenes() const { return !data_["views"].empty(); }
  json data() const {
    json all = data_;
    all["numbers"] = numbers_.json();
    return all;
  }

 private:
  /// Wraps content that may be wider than the page, so that only this content scrolls (also by
  /// keys).
  static std::string scrolled(const std::string& label, const std::string& html) {
    return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" +
           html_escaped(label) + "\">\n" + html + "</div>\n";
  }

  static std::string save_button(const std::string& kind, const std::size_t number,
                                 const std::string& of) {
    return "<button type=\"button\" data-save=\"" + kind + "\" data-number=\"" +
           std::to_string(number) + "\">Save CSV<span class=\"unseen\"> of " + html_escaped(of) +
           "</span></button>\n";
  }

  std::string table_element(const PageTable& table) {
    const std::size_t number = data_["tables"].size();
    data_["tables"].push_back({{"name", table.name}, {"csv", table.table.to_csv()}});
    const std::string shown = scrolled(table.caption, table.table.to_html(table.caption)) +
                              "<div class=\"tools\">" +
                              save_button("tables", number, table.caption) + "</div>\n";
    if (!table.folded) return "<div class=\"table\">" + shown + "</div>\n";
    return "<details class=\"table\"><summary>" + html_escaped(table.caption) + " (" +
           std::to_string(table.table.n_rows()) + " rows)</summary>" + shown + "</details>\n";
  }

  std::string figure_element(const Figure& figure) {
    check(figure);
    const std::size_t number = data_["figures"].size();
    data_["figures"].push_back(page_figure(figure, numbers_));
    return "<figure data-figure=\"" + std::to_string(number) + "\">\n" +
           html_element("h3", figure.title) + "<div class=\"plots\"></div>\n<figcaption>" +
           html_escaped(figure.caption) + "</figcaption>\n<div class=\"tools\">" +
           save_button("figures", number, figure.title) +
           "</div>\n<details><summary>Ranges of the curves</summary>" +
           scrolled("Ranges of the curves of " + figure.title, figure_in_words(figure)) +
           "</details>\n</figure>\n";
  }

  std::string view_element(const std::vector<ModePicture>& scenes) {
    const std::size_t number = data_["views"].size();
    json list = json::array();
    std::string names;
    for (const ModePicture& scene : scenes) {
      list.push_back(scene_of_(folder_, scene, numbers_));
      names += html_element("li", scene.title + ". " + scene.caption);
    }
    data_["views"].push_back(list);
    return "<figure class=\"view\" data-view=\"" + std::to_string(number) +
           "\">\n<div class=\"stage\"></div>\n<div class=\"still\">" +
           html_element(
               "p",
               "The browser has no WebGL, so the 3D view is replaced by a picture of one shape.") +
           inlined_picture(folder_ / "figures" / (scenes.front().name + ".png"),
                           scenes.front().title) +
           "</div>\n<figcaption></figcaption>\n<div class=\"tools\">" +
           save_button("views", number, "the visible shape") +
           "</div>\n<details><summary>List of the shapes</summary><ul>" + names +
           "</ul></details>\n</figure>\n";
  }

  const fs::path& folder_;
  const SceneReader& scene_of_;
  PackedNumbers numbers_;
  json data_ = {{"palette", json::array()},
                {"tables", json::array()},
                {"figures", json::array()},
                {"views", json::array()}};
  std::string contents_;
  std::size_t n_sections_ = 0;
};

std::string key_numbers(const std::vector<KeyNumber>& numbers) {
  if (numbers.empty()) return "";
  std::string html = "<dl class=\"key\">\n";
  for (const KeyNumber& number : numbers)
    html += "<div>" + html_element("dt", number.label) + "<dd><strong>" +
            html_escaped(number.value) + "</strong> " +
            (number.note.empty() ? "" : "<span>" + html_escaped(number.note) + "</span>") +
            "</dd></div>\n";
  return html + "</dl>\n";
}

/// The template with each {{NAME}} replaced in one pass; replaced text is not searched again.
std::string filled(const std::string_view text, const std::map<std::string, std::string>& values) {
  std::string result;
  std::size_t at = 0;
  while (true) {
    const std::size_t open = text.find("{{", at);
    result += text.substr(at, open - at);
    if (open == std::string_view::npos) return result;
    const std::size_t close = text.find("}}", open);
    result += values.at(std::string(text.substr(open + 2, close - open - 2)));
    at = close + 2;
  }
}

std::string script(const std::string_view text) {
  return "<script>\n" + std::string(text) + "\n</script>\n";
}

std::string scripts(const bool with_scenes) {
  std::string all = script(dygraphs_script());
  if (with_scenes)
    all += script(three_script()) + script(orbit_controls_script()) + script(page_scene_script());
  return all + script(page_script());
}

}  // namespace

std::string to_html(const Page& page, const fs::path& folder, const SceneReader& scene_of) {
  Body body(folder, scene_of);
  std::string sections;
  for (const PageSection& section : page.sections) sections += body.section(section);
  return filled(page_template(),
                {{"title", html_escaped(page.title)},
                 {"style", std::string(dygraphs_style()) + std::string(page_style())},
                 {"headline", html_escaped(page.headline)},
                 {"verdict", paragraphs(page.verdict)},
                 {"numbers", key_numbers(page.numbers)},
                 {"contents", body.contents()},
                 {"sections", sections},
                 {"origin", page_origin(folder)},
                 {"licences", html_escaped(page_licences())},
                 {"data", script_json(body.data())},
                 {"scripts", scripts(body.has_scenes())}});
}

void write_page(const fs::path& folder, const Page& page, const SceneReader& scene_of) {
  const std::string html = to_html(page, folder, scene_of);
  signals::write_file(folder / "report.html", [&](std::ostream& out) { out << html; });
}

}  // namespace vibrissa::report
