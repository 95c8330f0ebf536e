#include "report/page/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "signals/base/error.h"
#include "tests/report/example_page.h"
#include "tests/report/unpacked.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

using signals::UserError;
using signals::test::content_of;
using signals::test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;

/// The elements' own text: without the content of scripts and styles.
std::string markup_of(const std::string& html) {
  std::string markup;
  std::size_t at = 0;
  while (at < html.size()) {
    const std::size_t script = std::min(html.find("<script", at), html.find("<style", at));
    markup += html.substr(at, script - at);
    if (script == std::string::npos) break;
    at = html.find(html[script + 2] == 'c' ? "</script>" : "</style>", script);
  }
  return markup;
}

nlohmann::json data_of(const std::string& html) {
  const std::string start = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = html.find(start) + start.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

class ReportPage : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  Page page_ = testing::example_page(folder_.path(), 2000);
  std::string html_ = to_html(page_, folder_.path(), page_scene);
};

TEST_F(ReportPage, AsksForNothingElse) {
  const std::string markup = markup_of(html_);
  const std::regex reference(R"re((src|href|srcset|action|data)\s*=\s*"([^"]*)")re");
  for (auto match = std::sregex_iterator(markup.begin(), markup.end(), reference);
       match != std::sregex_iterator(); ++match)
    EXPECT_THAT((*match)[2].str(), ::testing::ContainsRegex("^(#|data:)"));
  EXPECT_THAT(html_, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html_, Not(HasSubstr("@import")));
  EXPECT_THAT(html_, Not(::testing::ContainsRegex("url\\( *['\"]?(http|//)")));
}

TEST_F(ReportPage, NoTextOfAFileBecomesMarkup) {
  const std::string markup = markup_of(html_);
  EXPECT_THAT(markup, Not(HasSubstr("<img src=x")));
  EXPECT_THAT(markup, Not(HasSubstr("alert(\"x\")")));
  // Title twice, verdict, headings, table, command line: as text, unchanged otherwise.
  EXPECT_GT(count(markup, "&lt;script&gt;alert(&quot;x&quot;)&lt;/script&gt;"), 6u);
  EXPECT_GT(count(markup, "{{style}}"), 6u) << "what is filled in is not filled in again";
  // Scripts of the page: data, dygraphs, three.js with its controls, and two of this project.
  EXPECT_EQ(count(html_, "</script>"), 6u);
}

TEST_F(ReportPage, HoldsTheNumbersOfEachFigure) {
  const nlohmann::json data = data_of(html_);
  std::vector<Figure> figures;
  for (const PageSection& section : page_.sections)
    figures.insert(figures.end(), section.figures.begin(), section.figures.end());
  ASSERT_EQ(data["figures"].size(), figures.size());
  for (std::size_t f = 0; f < figures.size(); ++f) {
    nlohmann::json found = data["figures"][f];
    for (auto& panel : found["panels"])
      for (auto& curve : panel["curves"])
        for (const char* name : {"x", "y", "y_low", "y_high"})
          if (curve.contains(name))
            curve[name] = testing::unpacked(data["numbers"][curve[name].get<int>()]);
    Figure expected = figures[f];
    for (Panel& panel : expected.panels)
      for (std::size_t c = 0; c < panel.curves.size(); ++c)
        panel.curves[c].colour = colour_number(panel, c);
    const auto read = found.get<Figure>();
    EXPECT_TRUE(to_csv(read) == to_csv(expected)) << expected.name;
    EXPECT_TRUE(nlohmann::json(read).dump() == nlohmann::json(expected).dump()) << expected.name;
  }
  EXPECT_EQ(data["tables"][0]["csv"], page_.sections[0].tables[0].table.to_csv());
}

TEST_F(ReportPage, EveryFigureHasATitleACaptionNumbersAndItsCsv) {
  const std::string markup = markup_of(html_);
  EXPECT_EQ(count(markup, "<figure"), 5u);
  EXPECT_EQ(count(markup, "<figcaption>"), 5u);
  EXPECT_EQ(count(markup, "<details><summary>Ranges of the curves"), 4u);
  EXPECT_EQ(count(markup, "<details><summary>List of the shapes"), 1u);
  EXPECT_EQ(count(markup, "data-save=\"figures\""), 4u);
  EXPECT_EQ(count(markup, "data-save=\"views\""), 1u);
  EXPECT_EQ(count(markup, "data-save=\"tables\""), 1u);
  EXPECT_THAT(markup, HasSubstr("<caption>Curves of the figure: Response before and after"));
}

TEST_F(ReportPage, FoldsTheTablesThatAreToBeFolded) {
  EXPECT_THAT(html_, Not(HasSubstr("<details class=\"table\">")));
  page_.sections[0].tables[0].folded = true;
  EXPECT_THAT(to_html(page_, folder_.path(), page_scene),
              HasSubstr("<details class=\"table\"><summary>Records (2 rows)</summary>"));
}

TEST_F(ReportPage, SaysHowItWasMadeAsRunJsonDoes) {
  const std::string markup = markup_of(html_);
  EXPECT_THAT(markup, HasSubstr("<code>vibrissa diagnose --real &#39;run &lt;/script&gt;"));
  EXPECT_THAT(markup, HasSubstr("2001-02-03T04:05:06Z"));
  EXPECT_EQ(to_html(page_, folder_.path(), page_scene), html_)
      << "nothing in it depends on the clock";
  std::filesystem::remove(folder_.path() / "run.json");
  EXPECT_THAT(to_html(page_, folder_.path(), page_scene), Not(HasSubstr("class=\"command\"")));
}

TEST_F(ReportPage, InlinesThePictureThatStandsInForAView) {
  EXPECT_THAT(markup_of(html_), Not(HasSubstr("<img")));
  folder_.file("figures/mode_1.png", "foobar");
  EXPECT_THAT(to_html(page_, folder_.path(), page_scene),
              HasSubstr("src=\"data:image/png;base64,Zm9vYmFy\""));
}

TEST_F(ReportPage, IsMuchSmallerThanItsFiguresInDecimals) {
  const Page page{.sections = {{.figures = {testing::example_trace(60000, "record")}}}};
  constexpr std::size_t libraries = 260000, bytes_a_sample = 11;
  EXPECT_LT(to_html(page, folder_.path(), page_scene).size(), libraries + bytes_a_sample * 60000);
}

TEST_F(ReportPage, CarriesTheLibraryOfViewsOnlyWithAView) {
  EXPECT_THAT(html_, HasSubstr("OrbitControls = function"));
  page_.sections.back().scenes.clear();
  EXPECT_THAT(to_html(page_, folder_.path(), page_scene),
              Not(HasSubstr("OrbitControls = function")));
}

TEST_F(ReportPage, IsWrittenWholeAndRefusesWhatCannotBeDrawn) {
  write_page(folder_.path(), page_, page_scene);
  EXPECT_EQ(content_of(folder_.path() / "report.html"), html_);
  page_.sections[0].figures[0].panels[0].curves[1].x.pop_back();
  EXPECT_THAT([&] { to_html(page_, folder_.path(), page_scene); },
              ::testing::ThrowsMessage<UserError>(HasSubstr("curve 2 ('simulation')")));
}

}  // namespace
}  // namespace vibrissa::report
