#include "checks/channel_facts.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/signals/white_noise.h"

namespace vibrissa::checks {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::string moment_name = "base_moment_N_m";
constexpr double channel_rate_hz = 1000.;
constexpr std::size_t n_of_channel = 20000;

signals::Record record_of(std::vector<double> x) {
  signals::Record record(channel_rate_hz, x.size());
  record.set_channel(moment_name, std::move(x));
  return record;
}

std::vector<double> noise(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return signals::test::white_noise(n_of_channel, 1., random);
}

ChannelFacts facts_of(std::vector<double> x) {
  return channel_facts(record_of(std::move(x)), moment_name);
}

TEST(ChannelFacts, OfAColumnWithoutUnitHaveNone) {
  signals::Record record(channel_rate_hz, 1000);
  record.set_channel("ax", std::vector<double>(1000, 1.));
  record.set_channel("moment_mN_m", std::vector<double>(1000, 1.));
  EXPECT_EQ(channel_facts(record, "ax").unit, "");
  EXPECT_NE(channel_facts(record, "moment_mN_m").unit, "");
}

TEST(ChannelFacts, TellLostSamplesFromACounter) {
  std::vector<double> count(200);
  std::iota(count.begin(), count.end(), 1.);
  const auto sentence_of = [](const std::vector<double>& x) {
    std::vector<Finding> findings;
    find_channel_faults(facts_of(x), 2000., findings);
    return findings.at(0).sentence;
  };
  EXPECT_THAT(sentence_of(count), testing::HasSubstr("counts the samples, and none is missing"));
  for (std::size_t i = 50; i < count.size(); ++i) count[i] += i < 90 ? 2. : 5.;
  EXPECT_THAT(sentence_of(count),
              testing::AllOf(testing::HasSubstr("5 are missing"), testing::HasSubstr("*5e-04'")));
  for (double& x : count) x *= 1e-3;
  EXPECT_THAT(sentence_of(count), testing::HasSubstr("never falls")) << "a time";
}

TEST(ChannelFacts, AreThoseOfAKnownSignal) {
  std::vector<double> x(n_of_channel);
  for (std::size_t i = 0; i < n_of_channel; ++i)
    x[i] = 3. + 2. * std::sin(2. * std::numbers::pi * 17. * double(i) / channel_rate_hz);
  const ChannelFacts facts = facts_of(x);
  EXPECT_NEAR(facts.mean, 3., 1e-9);
  EXPECT_NEAR(facts.rms, std::sqrt(2.), 1e-9);
  EXPECT_NEAR(facts.highest, 5., 1e-3);
  EXPECT_EQ(facts.unit, "N.m");
}

TEST(ChannelFacts, FindTheDriftAndNoneInNoise) {
  std::size_t n_false = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed)
    n_false += facts_of(noise(seed)).drift_per_s.has_value();
  EXPECT_LE(n_false, 2u) << "a thousandth is expected";
  std::vector<double> x = noise(1);
  for (std::size_t i = 0; i < n_of_channel; ++i) x[i] += 0.1 * double(i) / channel_rate_hz;
  const ChannelFacts facts = facts_of(x);
  ASSERT_TRUE(facts.drift_per_s);
  EXPECT_NEAR(*facts.drift_per_s, 0.1, 0.01);
}

TEST(ChannelFacts, FindTheStepOfAConverterAndNoneInFineValues) {
  std::vector<double> x = noise(2);
  EXPECT_FALSE(facts_of(x).step);
  for (double& v : x) v = 0.05 * std::round(v / 0.05);
  ASSERT_TRUE(facts_of(x).step);
  EXPECT_NEAR(*facts_of(x).step, 0.05, 1e-9);
}

TEST(ChannelFacts, FindHumWithItsSizeAndRarelyInNoise) {
  std::size_t n_false = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) n_false += !facts_of(noise(seed)).hum.empty();
  EXPECT_LE(n_false, 6u) << "one in a hundred is expected; six or more have a chance of 2 %";
  std::vector<double> x = noise(3);
  for (std::size_t i = 0; i < n_of_channel; ++i)
    x[i] += 0.5 * std::sin(2. * std::numbers::pi * 60. * double(i) / channel_rate_hz) +
            0.3 * std::sin(2. * std::numbers::pi * 180. * double(i) / channel_rate_hz);
  const ChannelFacts facts = facts_of(x);
  ASSERT_EQ(facts.hum.size(), 2u);
  EXPECT_EQ(facts.hum[0].frequency_hz, 60.);
  EXPECT_NEAR(facts.hum[0].rms, 0.5 / std::sqrt(2.), 0.03);
  EXPECT_EQ(facts.hum[1].frequency_hz, 180.);
}

TEST(ChannelFacts, TakeNoResonanceAndNoMultisineForHum) {
  std::vector<double> x(n_of_channel, 0.);
  for (int k = 1; k < 200; ++k)
    for (std::size_t i = 0; i < n_of_channel; ++i)
      x[i] += std::sin(2. * std::numbers::pi * 2. * k * double(i) / channel_rate_hz + k * k);
  EXPECT_THAT(facts_of(x).hum, IsEmpty()) << "50 Hz is one line of many";
  // White noise through a resonance at 50 Hz with damping ratio 0.02.
  const double w = 2. * std::numbers::pi * 50. / channel_rate_hz, r = std::exp(-0.02 * w);
  std::vector<double> y = noise(4);
  for (std::size_t i = 2; i < n_of_channel; ++i)
    y[i] += 2. * r * std::cos(w) * y[i - 1] - r * r * y[i - 2];
  EXPECT_THAT(facts_of(y).hum, IsEmpty());
}

TEST(ChannelFacts, OfAConstantAndOfNotFiniteValuesAreGiven) {
  EXPECT_NEAR(facts_of(std::vector<double>(100, 2.)).mean, 2., 1e-12);
  EXPECT_TRUE(std::isnan(facts_of({1., 2., std::nan(""), 4.}).rms));
}

}  // namespace
}  // namespace vibrissa::checks
