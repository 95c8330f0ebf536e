#include "signals/excitation/multisine.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "signals/base/error.h"
#include "signals/spectra/fft.h"
#include "tests/signals/peak.h"

namespace vibrissa::signals {
namespace {

using test::peak;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<double> experiment_tones_hz{12., 15., 19., 23., 26., 29.};
constexpr std::array all_phases{MultisinePhase::schroeder, MultisinePhase::random,
                                MultisinePhase::ascending, MultisinePhase::zero};

TEST(Multisine, HasPowerAtTheLinesAskedForAndNowhereElse) {
  const auto multisine = make_multisine(experiment_tones_hz, 3.9, MultisinePhase::schroeder);
  const auto spectrum = real_fft(multisine.sample(500., 500));
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const auto line = std::ranges::find(experiment_tones_hz, static_cast<double>(k));
    if (line == experiment_tones_hz.end()) {
      EXPECT_LT(std::abs(spectrum[k]) / 250., 1e-13) << k << " Hz";
    } else {
      const auto i = static_cast<std::size_t>(line - experiment_tones_hz.begin());
      const auto wanted = std::polar(multisine.amplitude[i], multisine.phase_rad[i]);
      EXPECT_LT(std::abs(spectrum[k] / 250. - wanted), 1e-13) << k << " Hz";
    }
  }
}

TEST(Multisine, LateSamplesAreAsExactAsEarlyOnes) {
  const auto multisine = make_multisine(experiment_tones_hz, 1., MultisinePhase::random, 5);
  const auto x = multisine.sample(500., 500 * 200);
  for (std::size_t i = 0; i < 500; ++i) EXPECT_EQ(x[i], x[x.size() - 500 + i]);
}

TEST(Multisine, SumPeaksAtTheAmplitudeAskedFor) {
  // 32 samples a period of the highest line miss the true peak by less than 1 - cos(pi / 32).
  for (const auto phase : all_phases) {
    const auto multisine = make_multisine(experiment_tones_hz, 3.9, phase, 1);
    const double found = peak(multisine.sample(29. * 32. * 8., 29 * 32 * 8));
    EXPECT_GE(found, 3.9 * (1. - 1e-12));
    EXPECT_LT(found, 3.9 / std::cos(std::numbers::pi / 32.));
  }
}

TEST(Multisine, SumPeaksAsAskedWhenThePeriodIsNoWholeSecond) {
  const std::vector<double> lines{3. / 2.048, 7. / 2.048, 40. / 2.048, 41. / 2.048};
  const auto multisine = make_multisine(lines, 2., MultisinePhase::random, 3);
  const double found = peak(multisine.sample(64000. / 2.048, 64000));
  EXPECT_GE(found, 2. * (1. - 1e-12));
  EXPECT_LT(found, 2. / std::cos(std::numbers::pi / 32.));
}

TEST(Multisine, OneLineHasItsPeakAsAmplitude) {
  const auto multisine = make_multisine(std::vector{31.47}, 2., MultisinePhase::schroeder);
  EXPECT_NEAR(multisine.amplitude[0], 2., 1e-14);
  EXPECT_EQ(multisine.phase_rad[0], 0.);
}

TEST(Multisine, SchroederPhasesAreTheSettledOnes) {
  const auto multisine = make_multisine(experiment_tones_hz, 1., MultisinePhase::schroeder);
  for (std::size_t i = 1; i <= 6; ++i)
    EXPECT_NEAR(multisine.phase_rad[i - 1],
                -std::numbers::pi * static_cast<double>(i * (i - 1)) / 6., 1e-14);
}

double crest(MultisinePhase phase) {
  return crest_factor(make_multisine(experiment_tones_hz, 1., phase).sample(14848., 14848));
}

// Published values of the six tones of the reference paper.
TEST(Multisine, ExperimentTonesHaveTheKnownCrestFactors) {
  EXPECT_NEAR(crest(MultisinePhase::ascending), 3.45, 0.005);
  EXPECT_NEAR(crest(MultisinePhase::zero), 3.15, 0.005);
}

TEST(Multisine, SchroederPhasesLowerTheCrestFactor) {
  EXPECT_LT(crest(MultisinePhase::schroeder), 0.9 * crest(MultisinePhase::zero));
}

// Schroeder's rule is made for evenly spaced lines; there it comes near a single sine's 1.41.
TEST(Multisine, SchroederPhasesOfEvenLinesComeNearASine) {
  std::vector<double> lines(20);
  for (std::size_t i = 0; i < lines.size(); ++i) lines[i] = static_cast<double>(i + 1);
  const auto x = make_multisine(lines, 1., MultisinePhase::schroeder).sample(2000., 2000);
  EXPECT_LT(crest_factor(x), 1.8);
}

TEST(Multisine, RandomPhasesFollowTheSeedAlone) {
  const auto first = make_multisine(experiment_tones_hz, 1., MultisinePhase::random, 7);
  const auto again = make_multisine(experiment_tones_hz, 1., MultisinePhase::random, 7);
  const auto other = make_multisine(experiment_tones_hz, 1., MultisinePhase::random, 8);
  EXPECT_EQ(first.phase_rad, again.phase_rad);
  EXPECT_NE(first.phase_rad, other.phase_rad);
  for (const double phase : first.phase_rad) {
    EXPECT_GE(phase, 0.);
    EXPECT_LT(phase, 2. * std::numbers::pi);
  }
}

TEST(Multisine, RefusesAFrequencyNotBelowHalfTheSamplingRate) {
  const auto multisine = make_multisine(experiment_tones_hz, 1., MultisinePhase::zero);
  EXPECT_NO_THROW(multisine.sample(58.1, 10));
  EXPECT_THAT([&] { multisine.sample(58., 10); },
              ThrowsMessage<UserError>(testing::AllOf(HasSubstr("29"), HasSubstr("58"))));
  EXPECT_THAT([&] { multisine.sample(-1., 10); }, ThrowsMessage<UserError>(HasSubstr("-1")));
}

TEST(Multisine, RefusesLinesThatMakeNone) {
  const auto make = [](std::vector<double> lines, double peak_amplitude = 1.) {
    return [=] { make_multisine(lines, peak_amplitude, MultisinePhase::zero); };
  };
  EXPECT_THAT(make({}), ThrowsMessage<UserError>(HasSubstr("no line")));
  EXPECT_THAT(make({3., 0.}), ThrowsMessage<UserError>(HasSubstr("frequency 0 Hz")));
  EXPECT_THAT(make({-3.}), ThrowsMessage<UserError>(HasSubstr("frequency -3 Hz")));
  EXPECT_THAT(make({NAN}), ThrowsMessage<UserError>(HasSubstr("frequency nan Hz")));
  EXPECT_THAT(make({5., 3., 5.}), ThrowsMessage<UserError>(HasSubstr("5 Hz is given twice")));
  EXPECT_THAT(make({1., std::numbers::sqrt2}),
              ThrowsMessage<UserError>(HasSubstr("no common period")));
  EXPECT_THAT(make({1.}, -2.), ThrowsMessage<UserError>(HasSubstr("peak amplitude -2")));
  EXPECT_THAT(make({1.}, INFINITY), ThrowsMessage<UserError>(HasSubstr("peak amplitude inf")));
}

TEST(MultisineLines, AreDistinctMultiplesOfTheResolutionWithinTheBand) {
  const double resolution = 1. / 2.048;
  const auto lines = multisine_lines(1., 200., 40, resolution);
  ASSERT_EQ(lines.size(), 40u);
  EXPECT_GE(lines.front(), 1.);
  EXPECT_LE(lines.back(), 200.);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double order = lines[i] / resolution;
    EXPECT_NEAR(order, std::round(order), 1e-9);
  }
  for (std::size_t i = 1; i < lines.size(); ++i)
    EXPECT_GT(lines[i], lines[i - 1] + 0.5 * resolution);
}

TEST(MultisineLines, AreSpreadLogarithmically) {
  const auto lines = multisine_lines(10., 1000., 5, 0.001);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(lines[i], std::pow(10., 1. + 0.5 * static_cast<double>(i)), 0.00051);
}

TEST(MultisineLines, FillABandThatHasJustRoomEnough) {
  EXPECT_THAT(multisine_lines(1., 5., 5, 1.), testing::ElementsAre(1., 2., 3., 4., 5.));
  EXPECT_THAT(multisine_lines(0.2, 5.9, 5, 1.), testing::ElementsAre(1., 2., 3., 4., 5.));
  EXPECT_THAT(multisine_lines(100., 103.9, 4, 1.), testing::ElementsAre(100., 101., 102., 103.));
  EXPECT_THAT(multisine_lines(0.3, 0.6, 4, 0.1),
              testing::Pointwise(testing::DoubleNear(1e-15), {0.3, 0.4, 0.5, 0.6}));
}

TEST(MultisineLines, OneLineStandsInTheLogarithmicMiddle) {
  EXPECT_THAT(multisine_lines(10., 1000., 1, 1.), testing::ElementsAre(100.));
}

TEST(MultisineLines, RefusesLinesThatDoNotFit) {
  const auto lines = [](double low, double high, std::size_t n, double resolution) {
    return [=] { multisine_lines(low, high, n, resolution); };
  };
  EXPECT_THAT(lines(1., 5., 6, 1.), ThrowsMessage<UserError>(HasSubstr("only 5 lines fit")));
  EXPECT_THAT(lines(1.1, 1.9, 1, 1.), ThrowsMessage<UserError>(HasSubstr("only 0 lines fit")));
  EXPECT_THAT(lines(5., 1., 2, 1.), ThrowsMessage<UserError>(HasSubstr("low <= high")));
  EXPECT_THAT(lines(0., 1., 2, 1.), ThrowsMessage<UserError>(HasSubstr("0 < low")));
  EXPECT_THAT(lines(1., NAN, 2, 1.), ThrowsMessage<UserError>(HasSubstr("low <= high")));
  EXPECT_THAT(lines(1., 5., 2, 0.), ThrowsMessage<UserError>(HasSubstr("positive resolution")));
  EXPECT_THAT(lines(1., 5., 0, 1.), ThrowsMessage<UserError>(HasSubstr("at least one line")));
}

TEST(CrestFactor, IsPeakOverRootMeanSquare) {
  EXPECT_NEAR(crest_factor(std::vector{1., -1., 1.}), 1., 1e-15);
  EXPECT_NEAR(crest_factor(std::vector{0., 0., -3., 0.}), 2., 1e-15);
  EXPECT_NEAR(crest_factor(Multisine{{1.}, {5.}, {0.}}.sample(64., 64)), std::numbers::sqrt2,
              1e-14);
}

TEST(CrestFactor, RefusesASignalWithoutPower) {
  EXPECT_THAT(
      [] {
        crest_factor(std::vector{0., 0.});
      },
      ThrowsMessage<UserError>(HasSubstr("zero")));
  EXPECT_THAT([] { crest_factor({}); }, ThrowsMessage<UserError>(HasSubstr("empty")));
}

}  // namespace
}  // namespace vibrissa::signals
