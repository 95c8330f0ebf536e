#include "report/pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "report/figures/figure.h"
#include "report/files/child_process.h"
#include "tests/report/environment.h"
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
  PictureReport draw(const PictureOptions& options = by_child) {
    return draw_pictures(folder_.path(), options);
  }
  bool exists(const std::string& name) const {
    return fs::exists(folder_.path() / "figures" / name);
  }
  void hide_xvfb_run() { path_ = std::make_unique<Environment>("PATH", empty_.path().string()); }
  void set_display(const std::optional<std::string>& display) {
    display_ = std::make_unique<Environment>("DISPLAY", display);
  }

  TemporaryFolder folder_, empty_;
  std::unique_ptr<Environment> path_, display_;
};

TEST_F(DrawPictures, SaysInOneLineWhyThereAreNoneWithoutADisplay) {
  add_figures();
  set_display(std::nullopt);
  hide_xvfb_run();
  const PictureReport report = draw();
  EXPECT_EQ(report.message,
            "there is no display and no xvfb-run: figures are available as CSV only; install the "
            "package xvfb");
  EXPECT_THAT(report.made, IsEmpty());
  EXPECT_FALSE(exists("a.png"));
  EXPECT_TRUE(exists("a.csv"));
}

TEST_F(DrawPictures, TakesAnEmptyDisplayForNone) {
  add_figures();
  set_display("");
  hide_xvfb_run();
  EXPECT_THAT(draw().message, HasSubstr("no display and no xvfb-run"));
}

TEST_F(DrawPictures, SaysThatThereIsNothingToDraw) {
  EXPECT_THAT(draw().message, HasSubstr("no figures to draw"));
  fs::create_directory(folder_.path() / "figures");
  EXPECT_THAT(draw().message, HasSubstr("no figures to draw"));
}

TEST_F(DrawPictures, FailsOnTheCommandLineWhenThereIsNothingToDraw) {
  for (const auto& display : {std::optional<std::string>(), std::optional<std::string>(":987")}) {
    set_display(display);
    const ChildResult child = run_child({by_child.program.string(), "draw", "/nowhere"}, 120.);
    EXPECT_EQ(child.code, 1) << child.what_happened();
    EXPECT_THAT(child.output, HasSubstr("no figures to draw in /nowhere"));
  }
}

TEST_F(DrawPictures, SurvivesADisplayThatCannotBeOpened) {
  add_figures();
  set_display(":987");
  hide_xvfb_run();
  const PictureReport report = draw();
  EXPECT_THAT(report.made, IsEmpty());
  EXPECT_THAT(report.message, AllOf(HasSubstr("available as CSV only"), HasSubstr("on the display"),
                                    HasSubstr("signal 6"), Not(HasSubstr("\n"))));
  EXPECT_THAT(report.chatter, HasSubstr("DISPLAY=:987")) << "what VTK said";
}

TEST_F(DrawPictures, EndsAChildThatHangs) {
  add_figures();
  set_display(":987");
  hide_xvfb_run();
  const auto script =
      empty_.file("hangs", "#!/bin/sh\necho drawn: figures/a.png\nexec /bin/sleep 1000\n");
  fs::permissions(script, fs::perms::owner_all);
  const PictureReport report = draw({.program = script, .time_limit_s = 0.5});
  EXPECT_THAT(report.message, AllOf(HasSubstr("1 picture drawn"), HasSubstr("within its time")));
  EXPECT_THAT(report.made, ElementsAre("figures/a.png"));
}

TEST_F(DrawPictures, SaysThatTheProgramCannotBeStarted) {
  add_figures();
  set_display(":987");
  hide_xvfb_run();
  EXPECT_THAT(draw({.program = "/nowhere/vibrissa"}).message,
              AllOf(HasSubstr("CSV only"), HasSubstr("could not be started")));
}

class DrawPicturesByXvfb : public DrawPictures {
 protected:
  void SetUp() override {
    if (find_program("xvfb-run").empty()) GTEST_SKIP() << "there is no xvfb-run; install xvfb";
    set_display(std::nullopt);
  }
};

TEST_F(DrawPicturesByXvfb, DrawsAllFigures) {
  add_figures();
  const PictureReport report = draw();
  EXPECT_THAT(report.made,
              ElementsAre("figures/a.png", "figures/a.svg", "figures/b.png", "figures/b.svg"))
      << report.message << "\n"
      << report.chatter;
  for (const fs::path& picture : report.made) EXPECT_TRUE(fs::exists(folder_.path() / picture));
  EXPECT_EQ(report.message, "4 pictures drawn in " + (folder_.path() / "figures").string());
  EXPECT_THAT(report.chatter, IsEmpty());
}

TEST_F(DrawPicturesByXvfb, TakesOverFromADisplayThatCannotBeOpened) {
  add_figures();
  set_display(":987");
  EXPECT_EQ(draw().made.size(), 4u);
}

TEST_F(DrawPicturesByXvfb, DrawsTheRestWhenOneIsBroken) {
  add_figures();
  const auto figures = folder_.path() / "figures";
  folder_.file("figures/broken.json", "{\"name\": \"broken\"}");
  folder_.file("figures/b.scene.json", "{}");
  folder_.file("figures/c.scene.json", R"({"name": "c", "vtu": "none.vtu", "displacement": "u"})");
  const PictureReport report = draw();
  EXPECT_EQ(report.made.size(), 4u) << report.chatter;
  EXPECT_THAT(report.problems,
              ElementsAre(HasSubstr("the same picture name b.png"),
                          AllOf(HasSubstr("broken.json"), HasSubstr("'panels' is missing")),
                          HasSubstr("none.vtu: the file does not exist")));
  EXPECT_THAT(report.message, AllOf(HasSubstr("4 pictures drawn"), HasSubstr("broken.json"),
                                    Not(HasSubstr("failure"))));
  EXPECT_FALSE(exists("broken.png"));
}

TEST_F(DrawPicturesByXvfb, IsReachedFromTheCommandLineWithoutADisplay) {
  add_figures();
  const ChildResult child =
      run_child({by_child.program.string(), "draw", folder_.path().string()}, 120.);
  EXPECT_TRUE(child.succeeded()) << child.output;
  EXPECT_THAT(child.output, HasSubstr("4 pictures drawn"));
  EXPECT_TRUE(exists("b.svg"));
}

}  // namespace
}  // namespace vibrissa::report
