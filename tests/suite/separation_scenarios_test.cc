#include "suite/separation_scenarios.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "signals/model/beam_model.h"
#include "tests/signals/rate.h"

namespace vibrissa::apps {
namespace {

using signals::test::rate_hz;

std::vector<double> noise(const std::size_t n) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  std::vector<double> x(n);
  for (double& value : x) value = normal(generator);
  return x;
}

double largest_difference(const std::vector<double>& x, const std::vector<double>& y) {
  double largest = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

const signals::ReducedModel beam = signals::beam_model({0.09, 4e-4, 1.7e-3, 0.02}, 2);

TEST(DriftingMoment, OfAResonanceThatStaysIsThatOfTheModel) {
  const auto a = noise(2000);
  const auto expected = signals::simulate(beam, {rate_hz, a.size(), a}).base_moment;
  const auto moment = suite::drifting_moment(beam, beam.modes[0].frequency_hz, a, rate_hz);
  const double size = *std::max_element(expected.begin(), expected.end());
  EXPECT_LT(largest_difference(moment, expected), 1e-10 * size);
}

// At the end of a slow drift the response equals that of a sensor with the final resonance.
TEST(DriftingMoment, EndsAsTheResponseOfASensorWithTheLastResonance) {
  const auto a = noise(200000);
  auto last = beam;
  last.modes[0].frequency_hz *= 0.9;
  const auto expected = signals::simulate(last, {rate_hz, a.size(), a}).base_moment;
  const auto moment = suite::drifting_moment(beam, last.modes[0].frequency_hz, a, rate_hz);
  double difference = 0., power = 0.;
  for (std::size_t i = a.size() - 500; i < a.size(); ++i) {
    difference += std::pow(moment[i] - expected[i], 2);
    power += std::pow(expected[i], 2);
  }
  EXPECT_LT(std::sqrt(difference / power), 0.02);
}

}  // namespace
}  // namespace vibrissa::apps
