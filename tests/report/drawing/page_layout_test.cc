#include "report/drawing/page_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "report/text/text.h"
#include "tests/report/letters.h"

namespace vibrissa::report {
namespace {

using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;

PageLayout page_of(const Figure& figure) {
  return lay_out(figure, wide_letters);
}

Curve curve(const std::string& label, const double x_low, const double x_high,
            const double y_low = 1e-6, const double y_high = 1e-3) {
  return {.label = label, .x = {x_low, x_high}, .y = {y_low, y_high}};
}

Figure bode() {
  Panel magnitude{.x_label = "Frequency [Hz]",
                  .y_label = "Magnitude [N m s\u00b2/m]",
                  .log_x = true,
                  .log_y = true};
  magnitude.curves = {curve("simulation", 1., 200.), curve("measured", 1.1, 190.)};
  Panel phase{.x_label = "Frequency [Hz]", .y_label = "Phase [\u00b0]", .log_x = true};
  phase.curves = {curve("simulation", 1., 200., -180., 0.), curve("measured", 1.1, 190.)};
  return {.name = "bode", .title = "Response", .panels = {magnitude, phase}};
}

Figure crowded() {
  Figure figure{.name = "crowded"};
  figure.title =
      "A title that is much too long for one line of the page, as titles of figures "
      "that want to tell all about themselves sometimes are";
  for (int p = 0; p < 3; ++p) {
    Panel panel{.title = "Panel number " + std::to_string(p),
                .x_label = "Time [s]",
                .y_label = "A very long name of a quantity that is shown [N m s\u00b2/(m kg)]"};
    for (int c = 0; c < 9; ++c)
      panel.curves.push_back(
          curve("effect number " + std::to_string(c + 10 * p), 0., p + 1., -1e-5 * c, 1e-5));
    figure.panels.push_back(panel);
  }
  return figure;
}

Figure spectra() {
  Panel panel{.x_label = "Frequency [Hz]", .y_label = "Density [(N m)\u00b2/Hz]", .log_y = true};
  panel.curves = {curve("", 0., 123456., 1e-30, 1e3)};
  return {.name = "spectra", .panels = {panel}};
}

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right() && b.left < a.right() && a.bottom < b.top() && b.bottom < a.top();
}

std::vector<std::string> texts(const PageLayout& page) {
  std::vector<std::string> all;
  for (const auto& text : page.texts) all.push_back(text.text);
  return all;
}

std::size_t count(const PageLayout& page, const std::string& text) {
  const auto all = texts(page);
  return static_cast<std::size_t>(std::count(all.begin(), all.end(), text));
}

TEST(PageLayout, KeepsTextsApartFromEachOtherAndFromThePlots) {
  for (const Figure& figure : {bode(), crowded(), spectra()}) {
    const PageLayout page = page_of(figure);
    for (std::size_t i = 0; i < page.texts.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_FALSE(overlap(box_of(page.texts[i]), box_of(page.texts[j])))
            << figure.name << ": '" << page.texts[i].text << "' and '" << page.texts[j].text << "'";
      for (const PanelLayout& panel : page.panels)
        EXPECT_FALSE(overlap(box_of(page.texts[i]), panel.plot))
            << figure.name << ": '" << page.texts[i].text << "' in a plot";
    }
  }
}

TEST(PageLayout, KeepsEverythingOnThePage) {
  for (const Figure& figure : {bode(), crowded(), spectra()}) {
    const PageLayout page = page_of(figure);
    for (const PlacedText& text : page.texts) {
      const Box box = box_of(text);
      EXPECT_GE(box.left, 0.) << text.text;
      EXPECT_GE(box.bottom, 0.) << text.text;
      EXPECT_LE(box.right(), page.width) << text.text;
      EXPECT_LE(box.top(), page.height) << text.text;
    }
    for (const PanelLayout& panel : page.panels) {
      EXPECT_GE(panel.plot.width, 800.);
      EXPECT_GE(panel.plot.height, 149.);
      for (const LegendSample& sample : panel.legend) {
        EXPECT_GT(sample.y, panel.plot.top());
        EXPECT_LE(sample.left + page.strokes.sample_width, page.width);
      }
    }
  }
}

TEST(PageLayout, HasTheSizeAskedForAndPlotsInLine) {
  const PageLayout page = page_of(bode());
  EXPECT_EQ(page.width, 1200);
  EXPECT_EQ(page.height, 800);
  EXPECT_EQ(page.panels[0].plot.left, page.panels[1].plot.left);
  EXPECT_EQ(page.panels[0].plot.width, page.panels[1].plot.width);
  EXPECT_EQ(page.panels[0].plot.height, page.panels[1].plot.height);
}

TEST(PageLayout, NamesThePlacesOfAnAxis) {
  Panel panel{.x_label = "Evidence [nats]", .y_names = {"delay", "hum", "mass"}};
  panel.curves = {curve("found", 1., 100., 1., 3.)};
  const PageLayout page = page_of({.name = "plan", .panels = {panel}});
  const Ticks& ticks = page.panels[0].y.ticks;
  ASSERT_EQ(ticks.marks.size(), 3u);
  EXPECT_EQ(ticks.marks[1], (Tick{2., "hum"}));
  EXPECT_EQ(page.panels[0].y.range.low, 0.5);
  EXPECT_EQ(page.panels[0].y.range.high, 3.5);
}

TEST(PageLayout, LabelsASharedAxisOnceAndTellsALegendOnce) {
  const PageLayout page = page_of(bode());
  EXPECT_EQ(count(page, "Frequency [Hz]"), 1u);
  EXPECT_EQ(count(page, "200"), 1u);
  EXPECT_EQ(count(page, "simulation"), 1u);
  EXPECT_EQ(page.panels[0].x.range, page.panels[1].x.range);
  EXPECT_TRUE(page.panels[1].legend.empty());
}

TEST(PageLayout, TellsALegendAgainWhenItIsAnother) {
  Figure figure = bode();
  figure.panels[1].curves[1].colour = 7;
  EXPECT_EQ(count(page_of(figure), "simulation"), 2u);
}

TEST(PageLayout, GivesAPartOfARecordAnAxisOfItsOwn) {
  Figure figure{.name = "record", .panels = std::vector<Panel>(2)};
  for (Panel& panel : figure.panels) panel.x_label = "Time [s]";
  figure.panels[0].curves = {curve("", 0., 23.)};
  figure.panels[1].curves = {curve("", 11., 12.)};
  const PageLayout page = page_of(figure);
  EXPECT_EQ(count(page, "Time [s]"), 2u);
  EXPECT_EQ(page.panels[0].x.range, (Range{0., 23.}));
  EXPECT_EQ(page.panels[1].x.range, (Range{11., 12.}));
}

TEST(PageLayout, JoinsNearlyEqualRangesOfNeighbours) {
  Figure figure{.name = "record", .panels = std::vector<Panel>(2)};
  for (Panel& panel : figure.panels) panel.x_label = "Time [s]";
  figure.panels[0].curves = {curve("", 0., 9.)};
  figure.panels[1].curves = {curve("", 1., 10.)};
  const PageLayout page = page_of(figure);
  EXPECT_EQ(page.panels[0].x.range, (Range{0., 10.}));
  EXPECT_EQ(page.panels[1].x.range, (Range{0., 10.}));
  figure.panels[1].x_range = Range{0., 5.};
  EXPECT_EQ(page_of(figure).panels[0].x.range, (Range{0., 9.}));
  EXPECT_EQ(page_of(figure).panels[1].x.range, (Range{0., 5.}));
}

TEST(PageLayout, FindsTheRangeOfWhatIsSeenAndCanBeShown) {
  Panel panel{.log_y = true, .x_range = Range{0., 2.}};
  panel.curves = {{.x = {0., 1., 2., 3., 1.}, .y = {1., 10., -5., 1e9, std::nan("")}},
                  {.style = CurveStyle::band, .x = {1.}, .y_low = {0.1}, .y_high = {2.}}};
  const Axis y = page_of({.name = "a", .panels = {panel}}).panels[0].y;
  EXPECT_NEAR(y.range.low, -1. - 0.05 * 2., 1e-12);
  EXPECT_NEAR(y.range.high, 1. + 0.05 * 2., 1e-12);
}

TEST(PageLayout, ShowsFlatCurvesAndNoneAtAll) {
  Panel flat, none;
  flat.curves = {curve("", 0., 1., 5., 5.)};
  const auto y = page_of({.name = "a", .panels = {flat, none}}).panels[0].y.range;
  EXPECT_LT(y.low, 5.);
  EXPECT_GT(y.high, 5.);
}

TEST(PageLayout, NeverBreaksALabelInsideItsUnit) {
  for (const auto& text : texts(page_of(crowded())))
    EXPECT_EQ(std::count(text.begin(), text.end(), '['), std::count(text.begin(), text.end(), ']'))
        << text;
}

TEST(PageLayout, PrintsACommonPowerOfTenBesideTheAxis) {
  Panel panel;
  panel.curves = {curve("", 0., 1., 0., 1e-4)};
  EXPECT_THAT(texts(page_of({.name = "a", .panels = {panel}})), Contains("\u00d710\u207b\u2076"));
  panel.curves = {curve("", 0., 1., 0., 10.)};
  EXPECT_THAT(texts(page_of({.name = "a", .panels = {panel}})),
              Not(Contains(::testing::StartsWith("\u00d7"))));
}

TEST(Axis, PutsValuesOnPaper) {
  const Axis linear{.logarithmic = false, .range = {-1., 3.}, .ticks = {}};
  EXPECT_EQ(linear.part(linear.on_paper(0.)), 0.25);
  const Axis logarithmic{.logarithmic = true, .range = {0., 2.}, .ticks = {}};
  EXPECT_EQ(logarithmic.part(logarithmic.on_paper(10.)), 0.5);
  EXPECT_TRUE(std::isnan(logarithmic.on_paper(0.)));
  EXPECT_TRUE(std::isnan(logarithmic.on_paper(-1.)));
  EXPECT_TRUE(std::isnan(linear.on_paper(INFINITY)));
}

}  // namespace
}  // namespace vibrissa::report
