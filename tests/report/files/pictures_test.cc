#include "report/pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "report/figures/figure.h"
#include "report/figures/mode_picture.h"
#include "report/files/child_process.h"
#include "tests/report/environment.h"
#include "tests/report/meshes.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

namespace fs = std::filesystem;
using signals::test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::Environment;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const PictureOptions by_child{.program = VIBRISSA_DRAW_CHILD};

Figure small_figure(const std::string& name) {
  Panel panel{.x_label = "Time [s]", .y_label = "Moment [N m]"};
  panel.curves = {{.label = "a", .x = {0., 1.}, .y = {0., 1.}}};
  return {.name = name, .title = "Title", .panels = {panel}};
}

class DrawPictures : public ::testing::Test {
 protected:
  void add_figures() {
    write_figure(folder_.path(), small_figure("b"));
    write_figure(folder_.path(), small_figure("a"));
  }
  void add_scene() {
    testing::write_grid(folder_.path() / "mode.vtu",
                        *testing::column_mesh(3, 0.02, 0.1, [](const testing::Point& x) {
                          return testing::Point{1e-5 * x[2], 0., 0.};
                        }));
    write_mode_picture(folder_.path(),
                       {.name = "s", .vtu = "mode.vtu", .displacement = "displacement_m"});
  }
  PictureReport draw(const PictureOptions& options = by_child) {
    return draw_pictures(folder_.path(), options);
  }
  bool exists(const std::string& name) const {
    return fs::exists(folder_.path() / "figures" / name);
  }
  void hide_xvfb_run() { path_ = std::make_unique<Environment>("PATH", empty_.path().string()); }
  void set_display(const std::optional<std::string>& display) {
    display_.reset();
    display_ = std::make_unique<Environment>("DISPLAY", display);
  }

  TemporaryFolder folder_, empty_;
  std::unique_ptr<Environment> path_, display_;
};

TEST_F(DrawPictures, DrawsFiguresWithoutADisplay) {
  add_figures();
  set_display(std::nullopt);
  hide_xvfb_run();
  const PictureReport report = draw({.program = "/nowhere/vibrissa"});
  EXPECT_THAT(report.made, ElementsAre("figures/a.pdf", "figures/a.png", "figures/a.svg",
                                       "figures/b.pdf", "figures/b.png", "figures/b.svg"));
  for (const fs::path& picture : report.made) EXPECT_TRUE(fs::exists(folder_.path() / picture));
  EXPECT_EQ(report.message, "6 pictures drawn in " + (folder_.path() / "figures").string());
}

TEST_F(DrawPictures, SaysInOneLineWhyThereAreNoScenesWithoutADisplay) {
  hide_xvfb_run();
  for (const auto& display : {std::optional<std::string>(), std::optional<std::string>("")}) {
    add_scene();
    set_display(display);
    const PictureReport report = draw();
    EXPECT_EQ(report.message,
              "0 pictures drawn in " + (folder_.path() / "figures").string() +
                  "; not drawn: shapes in 3-D, which need a display: there is no display and no "
                  "xvfb-run; install the package xvfb");
    EXPECT_THAT(report.made, IsEmpty());
  }
}

TEST_F(DrawPictures, SaysThatThereIsNothingToDraw) {
  EXPECT_THAT(draw().message, HasSubstr("no figures to draw"));
  fs::create_directory(folder_.path() / "figures");
  EXPECT_THAT(draw().message, HasSubstr("no figures to draw"));
}

TEST_F(DrawPictures, SurvivesADisplayThatCannotBeOpened) {
  add_figures();
  add_scene();
  set_display(":987");
  hide_xvfb_run();
  const PictureReport report = draw();
  EXPECT_EQ(report.made.size(), 6u) << "figures need no display";
  EXPECT_THAT(report.message,
              AllOf(HasSubstr("on the display"), HasSubstr("signal 6"), Not(HasSubstr("\n"))));
  EXPECT_THAT(report.chatter, HasSubstr("DISPLAY=:987")) << "what VTK said";
}

TEST_F(DrawPictures, EndsAChildThatHangs) {
  add_scene();
  set_display(":987");
  hide_xvfb_run();
  const auto script =
      empty_.file("hangs", "#!/bin/sh\necho drawn: figures/s.png\nexec /bin/sleep 1000\n");
  fs::permissions(script, fs::perms::owner_all);
  const PictureReport report = draw({.program = script, .time_limit_s = 0.5});
  EXPECT_THAT(report.message, AllOf(HasSubstr("1 picture drawn"), HasSubstr("within its time")));
  EXPECT_THAT(report.made, ElementsAre("figures/s.png"));
}

TEST_F(DrawPictures, SaysThatTheProgramCannotBeStarted) {
  add_scene();
  set_display(":987");
  hide_xvfb_run();
  EXPECT_THAT(draw({.program = "/nowhere/vibrissa"}).message, HasSubstr("could not be started"));
}

TEST_F(DrawPictures, DrawsTheRestWhenOneIsBroken) {
  add_figures();
  folder_.file("figures/broken.json", "{\"name\": \"broken\"}");
  const PictureReport report = draw();
  EXPECT_EQ(report.made.size(), 6u);
  EXPECT_THAT(report.problems,
              ElementsAre(AllOf(HasSubstr("broken.json"), HasSubstr("'panels' is missing"))));
  EXPECT_FALSE(exists("broken.png"));
}

class DrawPicturesByXvfb : public DrawPictures {
 protected:
  void SetUp() override {
    if (find_program("xvfb-run").empty()) GTEST_SKIP() << "there is no xvfb-run; install xvfb";
    set_display(std::nullopt);
  }
};

TEST_F(DrawPicturesByXvfb, DrawsScenesBesideFigures) {
  add_figures();
  add_scene();
  const PictureReport report = draw();
  EXPECT_EQ(report.made.size(), 7u) << report.message << "\n" << report.chatter;
  EXPECT_TRUE(exists("s.png"));
  EXPECT_THAT(report.problems, IsEmpty());
  EXPECT_THAT(report.chatter, IsEmpty());
}

TEST_F(DrawPicturesByXvfb, TakesOverFromADisplayThatCannotBeOpened) {
  add_scene();
  set_display(":987");
  EXPECT_THAT(draw().made, ElementsAre("figures/s.png"));
}

TEST_F(DrawPicturesByXvfb, DrawsTheRestWhenASceneIsBroken) {
  add_figures();
  add_scene();
  folder_.file("figures/b.scene.json",
               R"({"name": "b", "vtu": "mode.vtu", "displacement": "displacement_m"})");
  folder_.file("figures/c.scene.json", R"({"name": "c", "vtu": "none.vtu", "displacement": "u"})");
  const PictureReport report = draw();
  EXPECT_EQ(report.made.size(), 7u) << report.chatter;
  EXPECT_THAT(report.problems, ElementsAre(HasSubstr("the same picture name b.png"),
                                           HasSubstr("none.vtu: the file does not exist")));
  EXPECT_THAT(report.message, HasSubstr("7 pictures drawn"));
}

}  // namespace
}  // namespace vibrissa::report
