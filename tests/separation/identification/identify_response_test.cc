#include "separation/identification/identify_response.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::FrequencyResponse;
using testing::HasSubstr;

/// Lines of a model with noise of a given share of the largest value.
FrequencyResponse noisy_response(const Bvrm& model, const double noise, const std::uint64_t seed) {
  FrequencyResponse measured;
  for (double f = 2.; f < 220.; f += 0.5) measured.frequency_hz.push_back(f);
  measured.value = response(model, measured.frequency_hz);
  double peak = 0.;
  for (const auto& value : measured.value) peak = std::max(peak, std::abs(value));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0., noise * peak / std::sqrt(2.));
  for (auto& value : measured.value) value += std::complex<double>(normal(random), normal(random));
  measured.standard_deviation.assign(measured.value.size(), noise * peak);
  return measured;
}

class IdentifyResponse : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Modes, IdentifyResponse, testing::Values(1, 2));

TEST_P(IdentifyResponse, FindsOrderAndModesWithinTheDeviationsItStates) {
  Bvrm truth = test::sensor(GetParam(), -2e-7);
  std::ranges::sort(truth.modes, {}, &ModalTerm::a0);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto found = identify_response(noisy_response(truth, 1e-3, seed));
    EXPECT_EQ(found.order, 2 * GetParam());
    ASSERT_EQ(found.fit.modes.size(), GetParam());
    for (std::size_t k = 0; k < GetParam(); ++k) {
      const ModeEstimate& mode = found.fit.modes[k];
      const double within = 4.5 * mode.frequency_hz.standard_deviation;
      EXPECT_NEAR(mode.frequency_hz.value, truth.modes[k].frequency_hz(), within);
      EXPECT_LT(within, 0.02 * mode.frequency_hz.value);
    }
    EXPECT_GT(found.held_out_fit_percent, 98.);
  }
}

// One of the lines is held out, and the message counts all that are in the file.
TEST(IdentifyResponse, CountsTheFiniteLinesAndSaysHowManyItNeeds) {
  FrequencyResponse measured;
  measured.frequency_hz = {5., 5.25, 5.5, 5.75, 6., 6.25, 6.5};
  measured.value = response(test::sensor(1, 0.), measured.frequency_hz);
  for (const std::size_t i : {1, 3, 4, 5}) measured.value[i] = std::nan("");
  EXPECT_THAT(
      [&] { identify_response(measured, {.order = 2}); },
      testing::ThrowsMessage<signals::UserError>(testing::AllOf(
          HasSubstr("has 3 lines with a finite value; at least 4"), HasSubstr("more lines"))));
  measured.value[4] = measured.value[0];
  EXPECT_NO_THROW(identify_response(measured, {.order = 2, .direct_term = false}));
}

// Above the drive's band a measured response is noise, as its coherence says.
TEST(IdentifyResponse, GoesByCoherenceWhereThereIsNoDeviation) {
  const Bvrm truth = test::sensor(1, 0.);
  FrequencyResponse measured = noisy_response(truth, 1e-4, 1);
  measured.standard_deviation.clear();
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal(0., 1e-4);
  for (std::size_t i = 0; i < measured.value.size(); ++i) {
    const bool is_driven = measured.frequency_hz[i] < 100.;
    if (!is_driven) measured.value[i] = {normal(random), normal(random)};
    measured.coherence.push_back(is_driven ? 0.9999 : 0.05);
  }
  const auto found = identify_response(measured);
  EXPECT_EQ(found.order, 2U);
  EXPECT_NEAR(found.fit.modes[0].frequency_hz.value, truth.modes[0].frequency_hz(), 0.05);
  EXPECT_GT(found.held_out_fit_percent, 95.);
  measured.coherence.clear();
  EXPECT_LT(identify_response(measured).held_out_fit_percent, 20.);
}

// A curve through all its own lines would fit noise; the lines that it did not see tell.
TEST(IdentifyResponse, RecognisesTheOtherSignConvention) {
  signals::FrequencyResponse written;
  for (int i = 1; i <= 200; ++i) written.frequency_hz.push_back(0.5 * i);
  written.value = response(test::sensor(1, -2e-7), written.frequency_hz);
  EXPECT_FALSE(identify_response(written).conjugated);
  for (auto& value : written.value) value = std::conj(value);
  const IdentifiedResponse found = identify_response(written);
  EXPECT_TRUE(found.conjugated);
  EXPECT_EQ(found.order, 2u);
  EXPECT_NEAR(found.fit.modes[0].frequency_hz.value, 31.47, 1e-3);
  EXPECT_NEAR(found.fit.modes[0].damping_ratio.value, 0.027, 1e-5);
  EXPECT_GT(found.held_out_fit_percent, 99.);
}

TEST(IdentifyResponse, SaysThatNoiseIsNotExplained) {
  const Bvrm nothing{.modes = {make_modal_term(40., 0.05, 1e-9)}};
  const auto found = identify_response(noisy_response(nothing, 10., 3), {.order = 6});
  EXPECT_LT(found.held_out_fit_percent, 15.);
}

// A mode without damping would pass through one line that hum has raised.
TEST(IdentifyResponse, TakesNoStrayLineForAMode) {
  const Bvrm truth = test::sensor(1, -2e-7);
  FrequencyResponse measured = noisy_response(truth, 1e-4, 1);
  measured.value[96] += 3e-7;  // 50 Hz, a line that is fitted
  const auto found = identify_response(measured);
  EXPECT_EQ(found.order, 2U);
  EXPECT_NEAR(found.fit.modes[0].frequency_hz.value, truth.modes[0].frequency_hz(), 0.02);
}

TEST(IdentifyResponse, LeavesOutLinesWithoutAValue) {
  const Bvrm truth = test::sensor(1, 0.);
  FrequencyResponse measured = noisy_response(truth, 1e-4, 1);
  for (const std::size_t i : {7, 8, 9, 100}) measured.value[i] = std::nan("");
  EXPECT_GT(identify_response(measured).held_out_fit_percent, 99.);
}

TEST(IdentifyResponse, RefusesFewerLinesThanParameters) {
  const FrequencyResponse few{{10., 20.}, {1e-5, 2e-5}, {}, {}};
  EXPECT_THAT([&] { identify_response(few); },
              testing::ThrowsMessage<signals::UserError>(HasSubstr("lines")));
}

}  // namespace
}  // namespace vibrissa::separation
