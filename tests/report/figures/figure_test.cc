#include "report/figures/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "signals/base/error.h"
#include "signals/formats/text/text_file.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

using signals::UserError;
using signals::test::content_of;
using signals::test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Figure example() {
  Panel magnitude{.title = "Response",
                  .x_label = "Frequency [Hz]",
                  .y_label = "Magnitude [N m s\u00b2/m]",
                  .log_x = true,
                  .log_y = true,
                  .x_range = Range{1., 200.}};
  magnitude.curves = {
      {.label = "model", .x = {1., 37.3, 200.}, .y = {1e-6, 0.1, 1. / 3.}, .colour = 5},
      {.label = "fit", .style = CurveStyle::dashed, .x = {1., 2.}, .y = {1., 2.}},
      {.label = "a \"b\", c", .style = CurveStyle::points, .x = {3.}, .y = {4.}},
      {.style = CurveStyle::band, .x = {1., 2.}, .y_low = {0.5, 0.6}, .y_high = {1.5, 1.6}}};
  const Panel phase{
      .x_label = "Frequency [Hz]", .y_label = "Phase [\u00b0]", .y_range = Range{-180., 0.}};
  return {.name = "bode", .title = "Title", .caption = "Caption", .panels = {magnitude, phase}};
}

Figure with(const std::function<void(Figure&)>& change) {
  Figure figure = example();
  change(figure);
  return figure;
}

TEST(Figure, ComesBackFromItsFileAsItWas) {
  const TemporaryFolder folder;
  write_figure(folder.path(), example());
  EXPECT_EQ(read_figure(folder.path() / "figures" / "bode.json"), example());
}

TEST(Figure, WritesNullForWhatIsNotFiniteAndReadsItAsAGap) {
  const TemporaryFolder folder;
  write_figure(
      folder.path(), with([](Figure& figure) {
        figure.panels[0].curves[0].y = {std::nan(""), 2., -std::numeric_limits<double>::infinity()};
      }));
  const auto y = read_figure(folder.path() / "figures" / "bode.json").panels[0].curves[0].y;
  ASSERT_EQ(y.size(), 3u);
  EXPECT_TRUE(std::isnan(y[0]));
  EXPECT_EQ(y[1], 2.);
  EXPECT_TRUE(std::isnan(y[2]));
}

TEST(Figure, CsvHoldsEveryPointWithNamesAndUnits) {
  const TemporaryFolder folder;
  write_figure(folder.path(), example());
  const auto file = folder.path() / "figures" / "bode.csv";
  EXPECT_EQ(content_of(file), to_csv(example()));
  EXPECT_THAT(
      to_csv(example()),
      AllOf(HasSubstr("panel,curve,x_name,x,y_name,y,y_low,y_high\n"
                      "1,model,Frequency [Hz],1,Magnitude [N m s\u00b2/m],1e-06,,\n"
                      "1,model,Frequency [Hz],37.3,Magnitude [N m s\u00b2/m],0.1,,\n"),
            HasSubstr("1,\"a \"\"b\"\", c\",Frequency [Hz],3,Magnitude [N m s\u00b2/m],4,,\n"),
            HasSubstr("1,,Frequency [Hz],2,Magnitude [N m s\u00b2/m],,0.6,1.6\n")));
}

TEST(Figure, CsvIsReadByOurOwnReader) {
  const TemporaryFolder folder;
  const auto plain = with([](Figure& figure) { figure.panels[0].curves[2].label = "a, b"; });
  const signals::formats::TextFile csv(folder.file("a.csv", to_csv(plain)));
  EXPECT_EQ(csv.n_rows(), 8u);
  EXPECT_EQ(csv.columns().size(), 8u);
}

TEST(Figure, RefusesANameThatIsNoFileName) {
  const TemporaryFolder folder;
  for (const std::string name : {"", "../a", "a b", ".a", "a.scene"})
    EXPECT_THAT([&] { write_figure(folder.path(), with([&](Figure& f) { f.name = name; })); },
                ThrowsMessage<UserError>(HasSubstr("not a plain file name")))
        << name;
  EXPECT_EQ(folder.n_entries(), 0u);
}

TEST(Figure, RefusesNoPanelsAndTooMany) {
  EXPECT_THAT([] { check(with([](Figure& f) { f.panels.clear(); })); },
              ThrowsMessage<UserError>(HasSubstr("0 panels")));
  EXPECT_THAT([] { check(with([](Figure& f) { f.panels.resize(13); })); },
              ThrowsMessage<UserError>(HasSubstr("13 panels")));
  EXPECT_NO_THROW(check(with([](Figure& f) { f.panels.resize(12); })));
}

TEST(Figure, RefusesListsOfUnequalLengthNamingPanelAndCurve) {
  const auto message = [](const std::string& text) {
    return ThrowsMessage<UserError>(AllOf(HasSubstr("'bode', panel 1, curve " + text)));
  };
  EXPECT_THAT([] { check(with([](Figure& f) { f.panels[0].curves[1].y.pop_back(); })); },
              message("2 ('fit')"));
  EXPECT_THAT([] { check(with([](Figure& f) { f.panels[0].curves[3].y_low.pop_back(); })); },
              message("4"));
  EXPECT_THAT([] { check(with([](Figure& f) {
                     f.panels[0].curves[3].y = {1., 2.};
                   })); },
              message("4"));
  EXPECT_THAT([] { check(with([](Figure& f) {
                     f.panels[0].curves[0].y_low = {1., 2., 3.};
                   })); },
              message("1 ('model')"));
}

TEST(Figure, RefusesRangesThatCannotBeDrawn) {
  for (const Range range : {Range{2., 2.}, Range{3., 1.}, Range{0., std::nan("")}})
    EXPECT_THAT([&] { check(with([&](Figure& f) { f.panels[1].y_range = range; })); },
                ThrowsMessage<UserError>(HasSubstr("panel 2: y_range")));
  EXPECT_THAT([] { check(with([](Figure& f) {
                     f.panels[0].x_range = Range{0., 1.};
                   })); },
              ThrowsMessage<UserError>(HasSubstr("positive on a logarithmic axis")));
}

TEST(Figure, NamesFileAndEntryWhenAFileIsWrong) {
  const TemporaryFolder folder;
  const auto message_for = [&](const std::function<void(nlohmann::json&)>& change) {
    nlohmann::json json = example();
    change(json);
    try {
      read_figure(folder.file("wrong.json", json.dump()));
    } catch (const UserError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto curve = [](nlohmann::json& j) -> nlohmann::json& {
    return j["panels"][0]["curves"][0];
  };
  EXPECT_THAT(message_for([&](auto& j) { curve(j)["style"] = "dahsed"; }),
              AllOf(HasSubstr("wrong.json"), HasSubstr("dashed"), HasSubstr("band")));
  EXPECT_THAT(message_for([&](auto& j) { curve(j)["y"][1] = "2"; }), HasSubstr("not a number"));
  EXPECT_THAT(message_for([&](auto& j) { curve(j)["x"] = 3; }), HasSubstr("'x'"));
  EXPECT_THAT(message_for([&](auto& j) { curve(j)["colour"] = -1; }), HasSubstr("'colour'"));
  EXPECT_THAT(message_for([&](auto& j) { j.erase("panels"); }), HasSubstr("'panels' is missing"));
  EXPECT_THAT(message_for([&](auto& j) { j["panels"][0] = 1; }), HasSubstr("'panels'"));
  EXPECT_THAT(message_for([&](auto& j) { curve(j) = 1; }), HasSubstr("'curves'"));
  EXPECT_THAT(message_for([&](auto& j) { j["panels"][0]["x_range"] = {1.}; }),
              HasSubstr("'x_range'"));
  EXPECT_THAT(message_for([&](auto& j) { j["panels"][0].erase("y_label"); }),
              HasSubstr("'y_label' is missing"));
  EXPECT_THAT(message_for([&](auto& j) { j = 3; }), HasSubstr("'name' is missing"));
}

}  // namespace
}  // namespace vibrissa::report
