#include "trial/generator/circumstance_draw.h"

#include <gmock/gmock.h>

#include <map>

#include "trial/generator/trial_case.h"

namespace vibrissa::trial {
namespace {

TEST(CircumstanceDraw, IsTheSameForTheSameSeedAndDiffersBetweenSeeds) {
  int n_equal = 0;
  for (std::size_t number = 0; number < 63; ++number) {
    const CaseClass kind = class_of(number);
    EXPECT_EQ(draw_circumstances(5, number, kind), draw_circumstances(5, number, kind));
    n_equal += draw_circumstances(5, number, kind) == draw_circumstances(6, number, kind) ? 1 : 0;
  }
  // Two of 63 by chance: one in 7 x 3 x 3 and its way.
  EXPECT_LT(n_equal, 12);
}

TEST(CircumstanceDraw, DealsEveryValueEquallyOften) {
  std::map<std::string, int> counts;
  for (std::size_t number = 0; number < 42; ++number) {
    const Circumstances drawn = draw_circumstances(9, number, CaseClass::single);
    ++counts[to_string(drawn.set)];
    ++counts[to_string(drawn.distance)];
    ++counts[to_string(drawn.form_error)];
  }
  for (const RecordSet set : record_sets()) EXPECT_EQ(counts[to_string(set)], 6);
  for (const Distance distance : distances()) EXPECT_EQ(counts[to_string(distance)], 14);
  for (const FormError error : form_errors()) EXPECT_EQ(counts[to_string(error)], 14);
}

TEST(CircumstanceDraw, GivesEachClassWhatItNeeds) {
  for (std::size_t number = 0; number < 200; ++number) {
    EXPECT_NE(draw_circumstances(2, number, CaseClass::calibration_only).distance, Distance::exact);
    EXPECT_NE(draw_circumstances(2, number, CaseClass::wrong_metadata).set, RecordSet::two_files);
    const Circumstances any = draw_circumstances(2, number, CaseClass::single);
    if (any.way_in != WayIn::model) continue;
    EXPECT_EQ(any.form_error, FormError::zero) << "a model is exact";
    EXPECT_NE(any.set, RecordSet::two_files);
  }
}

}  // namespace
}  // namespace vibrissa::trial
