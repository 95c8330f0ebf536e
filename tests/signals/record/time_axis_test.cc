#include "signals/record/time_axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

// Times as a logger prints and a reader reads them.
class Printed {
 public:
  Printed(const std::size_t n, const char* const format, const std::function<double(double)>& time)
      : seconds_(n) {
    for (std::size_t i = 0; i < n; ++i) {
      char text[40];
      std::snprintf(text, sizeof text, format, time(static_cast<double>(i)));
      digits_.see(text);
      seconds_[i] = std::stod(text);
    }
  }
  TimeAxis axis() const {
    return find_time_axis({.times_s = seconds_, .digits = digits_, .file = "r.csv"});
  }

 private:
  std::vector<double> seconds_;
  TimeDigits digits_;
};

TEST(TimeDigits, RoundingIsHalfTheLastPlaceOfAFixedNumberOfDecimals) {
  TimeDigits digits;
  for (const char* const time : {"0.000", "0.012", "10.500", "123.456"}) digits.see(time);
  EXPECT_DOUBLE_EQ(digits.rounding(0.), 0.5e-3);
  EXPECT_DOUBLE_EQ(digits.rounding(123.456), 0.5e-3);
}

TEST(TimeDigits, RoundingGrowsWithTimePrintedToAFixedNumberOfDigits) {
  TimeDigits digits;
  for (const char* const time : {"0", "0.012345", "1.2e+1", "12.3457"}) digits.see(time);
  EXPECT_DOUBLE_EQ(digits.rounding(12.3457), 0.5e-4);
  EXPECT_DOUBLE_EQ(digits.rounding(1234.57), 0.5e-2);
}

TEST(TimeDigits, TakesExponentsIntoAccount) {
  TimeDigits coarse;
  coarse.see("1.25e+3");
  EXPECT_DOUBLE_EQ(coarse.rounding(0.), 0.5);
  TimeDigits fine;
  fine.see("1.25e-3");
  EXPECT_DOUBLE_EQ(fine.rounding(0.), 0.5e-5);
  fine.see("0e-2147483648");
  EXPECT_TRUE(std::isfinite(fine.rounding(1.)));
}

TEST(TimeAxis, FindsARateThatTheDigitsShowExactly) {
  const Printed exact(1000, "%.17g", [](const double i) { return 3. + i / 500.; });
  EXPECT_EQ(exact.axis().sampling_rate_hz, 500.);
  EXPECT_EQ(exact.axis().start_s, 3.);
  const Printed fraction(1000, "%.17g", [](const double i) { return i / 333.3; });
  EXPECT_EQ(fraction.axis().sampling_rate_hz, 333.3);
}

TEST(TimeAxis, FindsTheSimplestRateThatRoundedDigitsAllow) {
  const Printed whole_rate(10000, "%.4f", [](const double i) { return i / 1024.; });
  EXPECT_EQ(whole_rate.axis().sampling_rate_hz, 1024.);
  const Printed whole_period(10000, "%.3f", [](const double i) { return i * 0.003; });
  EXPECT_EQ(whole_period.axis().sampling_rate_hz, 1. / 0.003);
  const Printed odd_rate(10000, "%.3f", [](const double i) { return i / 87.46; });
  EXPECT_NEAR(odd_rate.axis().sampling_rate_hz, 87.46, 87.46 * 1e-3 / (10000. / 87.46));
}

TEST(TimeAxis, AllowsForTheRoundingOfPrintedDigits) {
  const Printed quarter_period(5000, "%.3f", [](const double i) { return 0.0004 + i / 487.; });
  EXPECT_NEAR(quarter_period.axis().sampling_rate_hz, 487., 0.05);
  const Printed six_digits(80000, "%g", [](const double i) { return i / 87.46; });
  EXPECT_NEAR(six_digits.axis().sampling_rate_hz, 87.46, 1e-3);
}

TEST(TimeAxis, AllowsAThousandthOfAPeriodOfJitterAndNoMore) {
  const auto times = [](const double jitter) {
    return Printed(1000, "%.12f", [=](const double i) {
      return (i + (i > 0. && i < 999. ? jitter * std::sin(i * i) : 0.)) / 500.;
    });
  };
  EXPECT_EQ(times(0.9e-3).axis().sampling_rate_hz, 500.);
  EXPECT_THAT([&] { times(3e-3).axis(); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("time is not uniform: line "),
                                             HasSubstr("0.3 % of a period"), HasSubstr("--rate"))));
}

TEST(TimeAxis, ReportsAGapWithItsPlaceAndLength) {
  const Printed gap(300, "%.3f", [](const double i) { return 0.002 * (i < 119. ? i : i + 6.); });
  EXPECT_THAT([&] { gap.axis(); },
              ThrowsMessage<UserError>(EndsWith(
                  "r.csv: gap in time between line 120 (0.236 s) and line 121 (0.25 s): 7 sampling "
                  "intervals where 1 was expected; column 'time_s': samples are never added or "
                  "removed; use only the rows before this place or only the rows after it")));
}

TEST(TimeAxis, ReportsASingleLostSampleWhereverItIs) {
  for (const double lost : {1., 2., 500., 998., 999.}) {
    const Printed gap(1000, "%.4f", [&](const double i) { return (i < lost ? i : i + 1.) / 400.; });
    EXPECT_THAT([&] { gap.axis(); },
                ThrowsMessage<UserError>(
                    AllOf(HasSubstr("line " + std::to_string(static_cast<int>(lost) + 2) + " ("),
                          HasSubstr("2 sampling intervals where 1 was expected"))))
        << lost;
  }
}

TEST(TimeAxis, CountsTheGapsBehindTheFirst) {
  const Printed gaps(
      300, "%.3f", [](const double i) { return 0.002 * (i + (i > 50.) + (i > 90.) + (i > 91.)); });
  EXPECT_THAT([&] { gaps.axis(); },
              ThrowsMessage<UserError>(
                  AllOf(HasSubstr("line 52 (0.1 s)"), HasSubstr("(2 more gaps follow)"))));
}

TEST(TimeAxis, SaysWhenDigitsAreTooCoarseToTellALostSample) {
  const Printed coarse(1000, "%.3f", [](const double i) { return i / 830.; });
  EXPECT_THAT([&] { coarse.axis(); },
              ThrowsMessage<UserError>(HasSubstr("write the time with more digits")));
  const Printed fine(1000, "%.6f", [](const double i) { return (i + (i > 500.)) / 830.; });
  EXPECT_THAT([&] { fine.axis(); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("gap"), Not(HasSubstr("digits")))));
}

TEST(TimeAxis, FindsALostSampleWhenAPeriodIsOneUnitOfTheLastDigit) {
  const Printed whole(1000, "%.3f", [](const double i) { return 0.001 * i; });
  EXPECT_EQ(whole.axis().sampling_rate_hz, 1000.);
  const Printed lost(1000, "%.3f", [](const double i) { return 0.001 * (i + (i > 499.)); });
  EXPECT_THAT([&] { lost.axis(); },
              ThrowsMessage<UserError>(HasSubstr("line 501 (0.499 s) and line 502")));
}

TEST(TimeAxis, RefusesTimeThatRunsBackwardOrStandsStill) {
  const Printed backward(100, "%.3f", [](const double i) { return 0.002 * (i == 40. ? 38.5 : i); });
  EXPECT_THAT([&] { backward.axis(); },
              ThrowsMessage<UserError>(HasSubstr(
                  "r.csv: time decreases between line 41 (0.078 s) and line 42 (0.077 s)")));
  const Printed still(100, "%.3f", [](const double i) { return 0.002 * (i == 40. ? 39. : i); });
  EXPECT_THAT(
      [&] { still.axis(); },
      ThrowsMessage<UserError>(HasSubstr("time does not increase between line 41 (0.078 s)")));
}

TEST(TimeAxis, RefusesASampleThatCrowdsTheOneBefore) {
  const Printed crowded(100, "%.4f",
                        [](const double i) { return 0.002 * (i - (i >= 40. ? 0.9 : 0.)); });
  EXPECT_THAT(
      [&] { crowded.axis(); },
      ThrowsMessage<UserError>(AllOf(HasSubstr("between line 41 (0.078 s) and line 42 (0.0782 s)"),
                                     HasSubstr("0.002 s were expected"))));
}

TEST(TimeAxis, RefusesARateThatDrifts) {
  const Printed drift(10000, "%.9f", [](const double i) { return 0.002 * i * (1. + 1e-7 * i); });
  EXPECT_THAT([&] { drift.axis(); }, ThrowsMessage<UserError>(HasSubstr("time is not uniform")));
}

TEST(TimeAxis, MeasuresRoundingInTheUnitOfTheColumn) {
  TimeDigits digits;
  std::vector<double> times_s;
  for (int i = 0; i < 1000; ++i) {
    const std::string text = std::to_string(std::lround(i * 11.4));
    digits.see(text);
    times_s.push_back(1e-3 * std::stod(text));
  }
  const TimeAxis axis =
      find_time_axis({.times_s = times_s, .digits = digits, .unit_s = 1e-3, .file = "r.csv"});
  EXPECT_NEAR(1. / axis.sampling_rate_hz, 0.0114, 1e-3 / 1000.);
}

}  // namespace
}  // namespace vibrissa::signals
