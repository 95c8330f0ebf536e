#include "diagnosis/search/calibrated_odds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vibrissa::diagnosis {
namespace {

TEST(Calibration, TakesItsShareOfTheLogOdds) {
  EXPECT_NEAR(std::log(calibrated_odds(1e-4, 0.5)), 0.5 * std::log(1e-4), 1e-12);
  EXPECT_DOUBLE_EQ(calibrated_odds(1e-4, 1.), 1e-4);
  EXPECT_EQ(calibrated_odds(0., 0.5), 0.);
}

TEST(Calibration, MakesNoAnswerLikelierThanItsFitsDo) {
  for (const double odds : {1e-12, 1e-3, 0.3, 0.99, 1., 3., 40.})
    EXPECT_GE(calibrated_odds(odds), odds);
}

TEST(Calibration, LeavesTheLikeliestAnswerTheLikeliest) {
  for (const double odds : {1e-12, 1e-3, 0.3, 0.99}) EXPECT_LT(calibrated_odds(odds), 1.);
  for (const double odds : {1., 3., 40.}) EXPECT_EQ(calibrated_odds(odds), odds);
}

constexpr AnswerKind kinds[] = {AnswerKind::none, AnswerKind::single, AnswerKind::several,
                                AnswerKind::outside};

TEST(Calibration, AnAnswerIsOfTheKindOfWhatItNames) {
  EXPECT_EQ(answer_kind("none"), AnswerKind::none);
  EXPECT_EQ(answer_kind("outside_catalogue"), AnswerKind::outside);
  EXPECT_EQ(answer_kind("hardening"), AnswerKind::single);
  EXPECT_EQ(answer_kind("sensor_gain"), AnswerKind::none);
  EXPECT_EQ(answer_kind("hardening+sensor_gain"), AnswerKind::single);
  EXPECT_EQ(answer_kind("delay+hardening+sensor_gain"), AnswerKind::several);
}

TEST(Calibration, NoTrustMakesAnAnswerSurer) {
  for (const AnswerKind kind : kinds)
    for (const double best : {0.01, 0.3, 0.5, 0.9, 0.999, 1.}) {
      EXPECT_GT(probability_of_tried(kind, best), 0.);
      EXPECT_LE(probability_of_tried(kind, best), 1.);
    }
}

TEST(Calibration, WhatIsLeftBelongsInPartToWhatIsUnknown) {
  for (const AnswerKind kind : kinds) {
    EXPECT_GE(unknown_share(kind), 0.);
    EXPECT_LT(unknown_share(kind), 1.);
  }
  // outside_catalogue already is such an answer.
  EXPECT_EQ(unknown_share(AnswerKind::outside), 0.);
}

TEST(Calibration, TheSurerTheFitsTheSurerTheAnswer) {
  for (const AnswerKind kind : kinds) {
    double before = 0.;
    for (const double best : {0.3, 0.5, 0.7, 0.9, 0.99, 0.999, 1.}) {
      const double now = best * probability_of_tried(kind, best);
      EXPECT_GE(now, before);
      before = now;
    }
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
