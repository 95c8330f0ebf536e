#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "report/drawing/draw.h"
#include "report/drawing/lettering.h"
#include "report/drawing/page_layout.h"
#include "report/figures/figure.h"
#include "report/figures/mode_picture.h"
#include "report/files/child_process.h"
#include "report/pictures.h"
#include "tests/report/meshes.h"
#include "tests/report/picture.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

namespace fs = std::filesystem;
using signals::test::content_of;
using signals::test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::Picture;
using ::testing::StartsWith;

class Draw : public ::testing::Test {
 protected:
  void draw() {
    const PictureReport report = draw_pictures(folder_.path(), {.program = VIBRISSA_DRAW_CHILD});
    ASSERT_TRUE(report.problems.empty() && !report.made.empty()) << report.message << "\n"
                                                                 << report.chatter;
  }
  void draw(const Figure& figure) {
    write_figure(folder_.path(), figure);
    draw();
  }
  fs::path file(const std::string& name) const { return folder_.path() / "figures" / name; }

  TemporaryFolder folder_;
};

/// Pixel of a point of a panel.
struct Place {
  double x, y;
};
Place place_of(const PanelLayout& panel, const double x, const double y) {
  return {panel.plot.left + panel.plot.width * panel.x.part(panel.x.on_paper(x)),
          panel.plot.bottom + panel.plot.height * panel.y.part(panel.y.on_paper(y))};
}

TEST_F(Draw, PutsEveryKindOfCurveWhereItBelongsInItsColour) {
  Panel linear{.title = "Linear",
               .x_label = "Time [s]",
               .y_label = "Moment [N m]",
               .x_range = Range{0., 10.},
               .y_range = Range{0., 1.}};
  linear.curves = {
      {.label = "line", .x = {0., 10.}, .y = {0.2, 0.4}, .colour = 1},
      {.label = "points", .style = CurveStyle::points, .x = {2., 8.}, .y = {0.8, 0.9}, .colour = 2},
      {.label = "band",
       .style = CurveStyle::band,
       .x = {0., 10.},
       .y_low = {0.5, 0.5},
       .y_high = {0.6, 0.7},
       .colour = 3},
      {.label = "dashed",
       .style = CurveStyle::dashed,
       .x = {0., 10.},
       .y = {0.1, 0.1},
       .colour = 5}};
  Panel logarithmic{.x_label = "Frequency [Hz]",
                    .y_label = "Magnitude [1]",
                    .log_x = true,
                    .log_y = true,
                    .x_range = Range{1., 100.},
                    .y_range = Range{1e-4, 1.}};
  // A power law is a straight line on logarithmic axes, whichever points it is given by.
  logarithmic.curves = {{.label = "1/f^2", .x = {1., 100.}, .y = {1., 1e-4}, .colour = 0}};
  const Figure figure{.name = "kinds",
                      .title = "a < b & \"c\"",
                      .caption = "caption here",
                      .panels = {linear, logarithmic}};
  draw(figure);

  const Picture picture(file("kinds.png"));
  EXPECT_EQ(picture.width(), 1200);
  EXPECT_EQ(picture.height(), 800);
  EXPECT_EQ(picture.at(2, 2), (Colour{255, 255, 255}));
  const PageLayout page = lay_out(figure, text_width);
  const auto seen = [&](const std::size_t panel, const double x, const double y,
                        const Colour& colour) {
    const Place place = place_of(page.panels[panel], x, y);
    return picture.has_near(place.x, place.y, colour);
  };
  for (const double x : {0.5, 3., 5., 9.5}) {
    EXPECT_TRUE(seen(0, x, 0.2 + 0.02 * x, palette_colour(1))) << x;
    EXPECT_FALSE(seen(0, x, 0.25 + 0.02 * x, palette_colour(1))) << x;
    EXPECT_TRUE(seen(0, x, 0.55, tint(palette_colour(3), band_tint))) << x;
    EXPECT_FALSE(seen(0, x, 0.45, tint(palette_colour(3), band_tint))) << x;
  }
  EXPECT_TRUE(seen(0, 2., 0.8, palette_colour(2)));
  EXPECT_TRUE(seen(0, 8., 0.9, palette_colour(2)));
  EXPECT_FALSE(seen(0, 5., 0.85, palette_colour(2))) << "points are not joined";
  for (const double f : {2., 10., 50.})
    EXPECT_TRUE(seen(1, f, 1. / (f * f), palette_colour(0))) << f;

  const Box plot = page.panels[0].plot;
  EXPECT_TRUE(picture.has_near(plot.left, plot.bottom + 0.77 * plot.height, {110, 110, 110}));
  EXPECT_TRUE(picture.has_near(plot.left + 0.33 * plot.width, plot.top(), {110, 110, 110}));
  EXPECT_TRUE(seen(0, 5., 0.95, {221, 221, 221})) << "grid";
  EXPECT_FALSE(seen(0, 5.5, 0.95, {221, 221, 221}));

  int n_dashed = 0, n_blank = 0;
  for (double x = 0.1; x < 9.9; x += 0.01)
    (seen(0, x, 0.1, palette_colour(5)) ? n_dashed : n_blank) += 1;
  EXPECT_GT(n_dashed, 400);
  EXPECT_GT(n_blank, 150);

  EXPECT_THAT(content_of(file("kinds.svg")),
              AllOf(HasSubstr("a &lt; b &amp;"), HasSubstr("caption here"), HasSubstr("<path")));
  EXPECT_THAT(content_of(file("kinds.pdf")),
              AllOf(StartsWith("%PDF"), HasSubstr("caption here"), EndsWith("%%EOF\n")));
}

TEST_F(Draw, ShowsASpikeOfOneSampleInALongTrace) {
  constexpr int n = 100000, spike = 43210;
  Panel panel{.x_label = "Time [s]", .y_label = "Moment [N m]", .y_range = Range{-0.1, 1.1}};
  Curve curve{.label = "trace", .colour = 1};
  for (int i = 0; i < n; ++i) {
    curve.x.push_back(i / 500.);
    curve.y.push_back(i == spike ? 1. : 0.);
  }
  panel.curves = {curve};
  const Figure figure{.name = "trace", .panels = {panel}};
  draw(figure);
  const Picture picture(file("trace.png"));
  const PanelLayout placed = lay_out(figure, text_width).panels[0];
  const Place place = place_of(placed, spike / 500., 0.5);
  int n_pixels = 0;
  for (int dx = -2; dx <= 2; ++dx)
    n_pixels += picture.at(static_cast<int>(place.x) + dx, static_cast<int>(place.y)) !=
                Colour{255, 255, 255};
  EXPECT_GE(n_pixels, 1);
  EXPECT_LT(fs::file_size(file("trace.svg")), 300000u) << "thinned";
}

TEST_F(Draw, ShowsNothingOutsideTheAxes) {
  Panel panel{.x_label = "x", .y_label = "y", .x_range = Range{0., 1.}, .y_range = Range{0., 1.}};
  panel.curves = {{.x = {-1., 2.}, .y = {-5., 6.}, .colour = 1},
                  {.style = CurveStyle::points, .x = {0.5, 1.05}, .y = {1.1, 0.5}, .colour = 1},
                  {.style = CurveStyle::band,
                   .x = {-1., 2.},
                   .y_low = {0.2, 0.2},
                   .y_high = {7., 7.},
                   .colour = 3}};
  const Figure figure{.name = "outside", .panels = {panel}};
  draw(figure);
  const Picture picture(file("outside.png"));
  const Box plot = lay_out(figure, text_width).panels[0].plot;
  for (int x = 0; x < picture.width(); ++x)
    for (int y = 0; y < picture.height(); ++y) {
      if (x > plot.left - 2 && x < plot.right() + 2 && y > plot.bottom - 2 && y < plot.top() + 2)
        continue;
      ASSERT_FALSE(picture.has(x, y, palette_colour(1))) << x << " " << y;
      ASSERT_FALSE(picture.has(x, y, tint(palette_colour(3), band_tint))) << x << " " << y;
    }
  EXPECT_GT(picture.count(palette_colour(1)), 100);
  EXPECT_THAT(content_of(file("outside.svg")), HasSubstr("clip-path="));
}

TEST_F(Draw, ShowsADeformedMeshWithItsColours) {
  const char* const display = std::getenv("DISPLAY");
  if (!(display && *display) && find_program("xvfb-run").empty())
    GTEST_SKIP() << "no display and no xvfb-run";
  // Displacement from 0 below to its largest above: from dark violet to yellow.
  testing::write_grid(folder_.path() / "mode.vtu",
                      *testing::column_mesh(6, 0.02, 0.1, [](const testing::Point& x) {
                        return testing::Point{1e-5 * x[2], 0., 0.};
                      }));
  write_mode_picture(folder_.path(), {.name = "mode_1",
                                      .title = "Mode 1",
                                      .vtu = "mode.vtu",
                                      .displacement = "displacement_m",
                                      .colour_label = "Displacement [m]"});
  draw();
  const Picture picture(file("mode_1.png"));
  EXPECT_GT(picture.height(), 800);
  EXPECT_GT(picture.width(), 400);
  // The colour bar shows both ends; the lit mesh, left of it, shades of them, yellow only above.
  EXPECT_GT(picture.count({253, 231, 37}), 20);
  EXPECT_GT(picture.count({68, 1, 84}), 20);
  const auto yellow_rows = [&](const int from, const int to) {
    int n = 0;
    for (int y = from; y < to; ++y)
      for (int x = 0; x < picture.width() / 2; ++x) {
        const Colour c = picture.at(x, y);
        n += c[0] > 120 && c[1] > 120 && c[2] < 90;
      }
    return n;
  };
  EXPECT_GT(yellow_rows(picture.height() / 2, picture.height()), 500);
  EXPECT_EQ(yellow_rows(0, picture.height() / 2), 0);
}

}  // namespace
}  // namespace vibrissa::report
