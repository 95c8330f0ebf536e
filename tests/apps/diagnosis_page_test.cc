#include "views/records/diagnosis_page.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

constexpr const char* hostile = R"(a</script><script>alert("1")</script>)";

diagnosis::Diagnosis example() {
  diagnosis::Diagnosis d;
  d.verdict = "joint_friction+stiffness";
  diagnosis::ErrorScore score{.record = hostile,
                              .nrmse_before = 0.78,
                              .nrmse_after = 0.03,
                              .noise_floor = 0.02,
                              .gap_closed = 0.97,
                              .gap_closed_ci95 = std::array{0.95, 0.98}};
  diagnosis::RankedAnswer first{
      .name = d.verdict,
      .probability = 0.9,
      .parameters = {{"stiffness", "ratio", "1", "times the simulated value", 0.71, {0.7, 0.72}}},
      .held_out = diagnosis::HeldOutScore{.overall = score, .records = {score}}};
  d.attribution = {.reducible = 0.6,
                   .changes = {{.id = "stiffness", .calibration = true, .share = 0.8},
                               {.id = "joint_friction", .share = 0.2}}};
  d.ranking = {first,
               {.name = "stiffness", .probability = 0.1},
               {.name = "delay", .probability = 1e-6, .parameters = {{"delay", "time", "s"}}}};
  d.wind_speed_error_m_s = {.before = 0.15, .after = 0.012};
  d.findings = {{diagnosis::FindingKind::clipped_channel, hostile, "is clipped"}};
  d.next = {.name = "wide_band", .why = "it splits", .split_probability = 0.4};
  d.trace = {.record = hostile};
  for (int i = 0; i < 4000; ++i) {
    d.trace.time_s.push_back(i / 1000.);
    for (auto* list : {&d.trace.measured, &d.trace.nominal, &d.trace.updated})
      list->push_back(1e-6 * std::sin(0.1 * i));
  }
  return d;
}

TEST(DiagnosisPage, SaysVerdictLocationCauseImprovementAndNextExperiment) {
  const report::Page page = views::diagnosis_page(example());
  EXPECT_EQ(page.headline,
            "Joint friction and stiffness explain why the bench differs from the simulation");
  EXPECT_THAT(page.verdict,
              ElementsAre("The simulation lacks joint_friction and needs recalibration: set "
                          "stiffness to 0.71 times the simulated value.",
                          HasSubstr("Doubtful: a</script>")));
  std::vector<std::string> headings;
  for (const report::PageSection& section : page.sections) headings.push_back(section.heading);
  EXPECT_THAT(headings, ElementsAre("Where", "Cause", "Improvement", "Next experiment"));
  EXPECT_THAT(page.sections[3].text, ElementsAre(HasSubstr("Measure wide band: it splits")));
}

TEST(DiagnosisPage, GivesEachNumberItsUnitAndItsInterval) {
  const report::Page page = views::diagnosis_page(example());
  ASSERT_THAT(page.numbers, SizeIs(4));
  EXPECT_EQ(page.numbers[0].value, "90 %");
  EXPECT_EQ(page.numbers[1].value, "97 %");
  EXPECT_EQ(page.numbers[1].note, "95 % interval 95 % to 98 %");
  EXPECT_EQ(page.numbers[2].value, "3 %");
  EXPECT_EQ(page.numbers[3].value, "0.012 m/s");
}

TEST(DiagnosisPage, ShowsTheParametersOfAnswersThatAreNotImprobable) {
  const report::PageSection cause = views::diagnosis_page(example()).sections[1];
  ASSERT_THAT(cause.tables, SizeIs(3));
  EXPECT_EQ(cause.tables[1].table.to_csv(),
            "answer,effect,parameter,value,95 % from,95 % to,unit,at limit of range\n"
            "joint_friction+stiffness,stiffness,ratio,0.71,0.7,0.72,times the simulated value,\n");
}

TEST(DiagnosisPage, ShowsTheWholeHeldOutRecordAndItsFirstSecond) {
  const report::PageSection improvement = views::diagnosis_page(example()).sections[2];
  ASSERT_THAT(improvement.figures, SizeIs(1));
  ASSERT_THAT(improvement.figures[0].panels, SizeIs(2));
  EXPECT_THAT(improvement.figures[0].panels[0].curves[0].x, SizeIs(4000));
  EXPECT_THAT(improvement.figures[0].panels[1].curves[0].x, SizeIs(1000));
}

TEST(DiagnosisPage, SaysInPlainWordsWhatIsNoEffect) {
  diagnosis::Diagnosis d;
  EXPECT_THAT(views::diagnosis_page(d).headline, HasSubstr("No cause: noise and"));
  d.verdict = "outside_catalogue";
  EXPECT_THAT(views::diagnosis_page(d).headline, HasSubstr("a cause that is not in the catalogue"));
  d.verdict = "stiffness";
  EXPECT_THAT(views::diagnosis_page(d).verdict, ElementsAre("The simulation needs recalibration."));
  d.verdict = "delay";
  EXPECT_THAT(views::diagnosis_page(d).headline, HasSubstr("Delay explains why"));
}

TEST(DiagnosisPage, NamesOfRecordsNeverBecomeMarkup) {
  const Folder folder;
  const std::string html = report::to_html(views::diagnosis_page(example()), folder.file(""));
  EXPECT_THAT(html, Not(HasSubstr(hostile)));
  EXPECT_THAT(html, HasSubstr("a&lt;/script&gt;&lt;script&gt;alert(&quot;1&quot;)"));
  EXPECT_THAT(html, HasSubstr(R"(a\u003c/script\u003e\u003cscript\u003ealert(\"1\"))"));
}

TEST(DiagnosisPage, HoldsADiagnosisOfSixtySecondsInSixMegabytes) {
  diagnosis::Diagnosis d = example();
  d.trace = {.record = "long"};
  for (int i = 0; i < 60000; ++i) {
    d.trace.time_s.push_back(i / 1000.);
    for (auto* list : {&d.trace.measured, &d.trace.nominal, &d.trace.updated})
      list->push_back(1e-6 *
                      std::sin(0.1 * i * static_cast<double>(list == &d.trace.nominal ? 2 : 1) +
                               (list == &d.trace.updated ? 0.3 : 0.)));
  }
  const Folder folder;
  EXPECT_LT(report::to_html(views::diagnosis_page(d), folder.file("")).size(), 6000000u);
}

}  // namespace
}  // namespace vibrissa::apps
