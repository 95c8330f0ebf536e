#include <gmock/gmock.h>

#include "fem/motion/substep_control.h"

#include "signals/base/error.h"

namespace vibrissa::fem {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double swing_m = 1e-3;  // the largest displacement

/// Goes through an interval whose error with one substep would be this part of the swing.
IntervalSteps cross(SubstepControl& control, const double error_of_one) {
  control.begin_interval();
  while (true) {
    const double n = control.substeps();
    if (control.accept(error_of_one * swing_m / (n * n), swing_m)) return control.interval();
  }
}

TEST(SubstepControl, ACalmIntervalTakesTheLeastNumberAtOnce) {
  SubstepControl control(3, {1e-3, 1e-6, 48});
  for (int i = 0; i < 20; ++i) {
    const IntervalSteps interval = cross(control, 5e-3);  // 5e-3/9 is within
    EXPECT_EQ(interval.substeps, 3u);
    EXPECT_EQ(interval.n_rejected, 0u);
  }
}

TEST(SubstepControl, AnErrorOverToleranceIsBroughtWithinItByOneMoreTry) {
  for (const double error : {1.1e-3, 3e-3, 2e-2, 0.3, 0.9}) {
    SubstepControl control(1, {1e-3, 1e-6, 64});
    const IntervalSteps interval = cross(control, error);
    EXPECT_EQ(interval.n_rejected, 1u) << error;
    EXPECT_LE(interval.error, 1e-3);
    EXPECT_GT(interval.error, 1e-3 / 8.01) << "more substeps than are needed, at " << error;
  }
}

TEST(SubstepControl, AtTheMostSubstepsAnErrorStandsAndIsTold) {
  SubstepControl control(1, {1e-3, 1e-6, 8});
  const IntervalSteps interval = cross(control, 1.);
  EXPECT_EQ(interval.substeps, 8u);
  EXPECT_DOUBLE_EQ(interval.error, 1. / 64.);
  EXPECT_EQ(summarise({interval}, 1e-3).n_over_tolerance, 1u);
}

TEST(SubstepControl, FewerSubstepsAreTakenOnlyAfterSeveralCalmIntervalsInTurn) {
  SubstepControl control(1, {1e-3, 1e-6, 64});
  const unsigned int most = cross(control, 0.02).substeps;
  ASSERT_GE(most, 4u);
  for (int lull = 0; lull < 5; ++lull) {
    for (int i = 0; i < 7; ++i) EXPECT_EQ(cross(control, 1e-5).substeps, most);
    EXPECT_EQ(cross(control, 0.01).substeps, most);  // ends the lull
  }
  for (int i = 0; i < 8; ++i) EXPECT_EQ(cross(control, 1e-5).substeps, most);
  EXPECT_EQ(cross(control, 1e-5).substeps, 1u);
}

TEST(SubstepControl, TheWorstOfTheCalmIntervalsSaysHowMuchFewer) {
  SubstepControl control(1, {1e-3, 1e-6, 64});
  const unsigned int most = cross(control, 0.2).substeps;
  ASSERT_EQ(most, 32u);
  cross(control, 0.02);  // 8 substeps bring it to a third of the tolerance
  for (int i = 0; i < 7; ++i) cross(control, 1e-5);
  EXPECT_EQ(cross(control, 1e-5).substeps, 8u);
}

TEST(SubstepControl, TheReferenceIsTheLargestDisplacementSoFarAndAtLeastTheLeast) {
  SubstepControl control(1, {1e-3, 1e-4, 64});
  control.begin_interval();
  EXPECT_TRUE(control.accept(0.9e-7, 0.));  // of the least one
  EXPECT_NEAR(control.interval().error, 0.9e-3, 1e-12);
  control.begin_interval();
  EXPECT_TRUE(control.accept(0.9e-5, 1e-2));
  control.begin_interval();
  EXPECT_TRUE(control.accept(0.9e-5, 1e-6)) << "the larger one is forgotten";
}

TEST(SubstepControl, ATryWithoutBalanceDoublesTheSubstepsUpToTheMost) {
  SubstepControl control(2, {1e-3, 1e-6, 8});
  control.begin_interval();
  EXPECT_TRUE(control.refine());
  EXPECT_EQ(control.substeps(), 4u);
  EXPECT_TRUE(control.refine());
  EXPECT_EQ(control.substeps(), 8u);
  EXPECT_FALSE(control.refine());
  EXPECT_TRUE(control.accept(0., 0.));
  EXPECT_EQ(control.interval().n_rejected, 2u);
}

TEST(SubstepControl, GoesOnFromItsMemory) {
  for (const int n_calm : {0, 3, 7, 8}) {
    SubstepControl control(1, {1e-3, 1e-6, 64}), other = control, third = control;
    cross(control, 0.2);
    cross(control, 0.02);
    for (int i = 0; i < n_calm; ++i) cross(control, 1e-5);
    std::map<std::string, double> numbers;
    control.add_to(numbers);
    other.restore(numbers);
    third.restore(numbers);
    EXPECT_TRUE(third.accept(0.5e-6, 0.)) << "the largest displacement is forgotten";
    for (int i = 0; i < 10; ++i) {
      EXPECT_EQ(cross(other, 1e-5).substeps, cross(control, 1e-5).substeps) << n_calm << " " << i;
      EXPECT_EQ(other.interval().error, control.interval().error);
    }
  }
}

TEST(SubstepControl, BadOptionsAreRefusedByTheNameOfTheEntry) {
  const auto expect_refusal = [](const unsigned int least, const SubstepOptions& options,
                                 const std::string& name, const std::string& value) {
    EXPECT_THAT([&] { SubstepControl(least, options); },
                testing::ThrowsMessage<signals::UserError>(
                    AllOf(HasSubstr("Transient/" + name), HasSubstr(value))));
  };
  expect_refusal(1, {0., 1e-6, 8}, "Time tolerance", "= 0");
  expect_refusal(1, {-1e-3, 1e-6, 8}, "Time tolerance", "-0.001");
  expect_refusal(1, {1e-3, 0., 8}, "Least displacement", "= 0");
  expect_refusal(1, {1e-3, 1e-6, 0}, "Most substeps", "= 0");
  expect_refusal(1, {1e-3, 1e-6, 48}, "Most substeps", "= 48");
  expect_refusal(3, {1e-3, 1e-6, 32}, "Most substeps", "Transient/Substeps = 3");
  expect_refusal(4, {1e-3, 1e-6, 2}, "Most substeps", "= 2");
  EXPECT_NO_THROW(SubstepControl(3, {1e-3, 1e-6, 48}));
  EXPECT_NO_THROW(SubstepControl(1, {1e-3, 1e-6, 1}));
}

}  // namespace
}  // namespace vibrissa::fem
