#include "separation/model/mode_step.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "tests/signals/rate.h"

namespace vibrissa::separation {
namespace {

using std::numbers::pi;

struct Pole {
  double frequency_hz, damping_ratio;
  double a0() const { return std::pow(2. * pi * frequency_hz, 2); }
  double a1() const { return 4. * pi * frequency_hz * damping_ratio; }
};

const std::array<Pole, 6> poles{Pole{31.47, 0.027}, {0.05, 0.5},      {240., 0.001},
                                {40., 1.},          {40., 1.0000001}, {60., 7.}};
using signals::test::rate_hz;

TEST(ModeStep, HasThePolesOfTheSampledMode) {
  for (const Pole& pole : poles) {
    const ModeStep step(pole.a1(), pole.a0(), rate_hz, Hold::first_order);
    const std::complex<double> root =
        std::sqrt(std::complex<double>(pole.a1() * pole.a1() / 4. - pole.a0()));
    const std::complex<double> z1 = std::exp((-pole.a1() / 2. + root) / rate_hz);
    const std::complex<double> z2 = std::exp((-pole.a1() / 2. - root) / rate_hz);
    EXPECT_NEAR(step.pole1.value, -(z1 + z2).real(), 1e-13);
    EXPECT_NEAR(step.pole2.value, (z1 * z2).real(), 1e-13);
  }
}

std::complex<double> sampled_response(const ModalTerm& mode, double rate, Hold hold, double f) {
  const ModeStep step(mode.a1, mode.a0, rate, hold);
  const auto late = [&](std::size_t n) {
    return std::polar(1., -2. * pi * f / rate * static_cast<double>(n));
  };
  std::complex<double> sum = 0.;
  for (std::size_t j = 0; j < 4; ++j)
    sum += (mode.b1 * step.b1_taps[j].value + mode.b0 * step.b0_taps[j].value) * late(j);
  return sum / (1. + step.pole1.value * late(1) + step.pole2.value * late(2));
}

// A slow sine lies so near its straight lines or steps that the sampled response tends to the
// continuous one; the images' share falls with the square (steps: first order, half a sample late).
TEST(ModeStep, TendsToTheContinuousResponseAtTheOrderOfItsHold) {
  Bvrm model;
  model.modes = {make_modal_term(30., 0.1, 2., 0.01)};
  const std::complex<double> exact = response(model, std::vector{20.})[0];
  const auto error = [&](double rate, Hold hold) {
    return std::abs(sampled_response(model.modes[0], rate, hold, 20.) - exact);
  };
  EXPECT_NEAR(std::log2(error(2000., Hold::first_order) / error(4000., Hold::first_order)), 2.,
              0.05);
  EXPECT_NEAR(std::log2(error(2000., Hold::zero_order) / error(4000., Hold::zero_order)), 1., 0.05);
}

TEST(ModeStep, HasTheStaticGainOfTheMode) {
  for (const Pole& pole : poles)
    for (const Hold hold : {Hold::first_order, Hold::zero_order, Hold::band_limited})
      for (const double fraction : {0., 0.4}) {
        if (hold == Hold::band_limited && fraction > 0.) continue;
        const ModeStep step(pole.a1(), pole.a0(), rate_hz, hold, fraction);
        double gain = 0., rate_gain = 0.;
        for (const Sensitive& tap : step.b0_taps) gain += tap.value;
        for (const Sensitive& tap : step.b0_mid) gain += tap.value;
        for (const Sensitive& tap : step.b1_taps) rate_gain += tap.value;
        for (const Sensitive& tap : step.b1_mid) rate_gain += tap.value;
        const double denominator = 1. + step.pole1.value + step.pole2.value;
        // For the slowest mode 1 + pole1 + pole2 is small: its digits go to cancellation.
        const double tolerance = pole.frequency_hz < 1. ? 1e-8 : 1e-11;
        EXPECT_NEAR(gain / denominator * pole.a0(), 1., tolerance);
        EXPECT_NEAR(rate_gain / denominator * std::sqrt(pole.a0()), 0., tolerance);
      }
}

// Every number in a step, for comparison of derivatives.
std::vector<Sensitive> numbers(const ModeStep& step) {
  std::vector<Sensitive> all{step.pole1, step.pole2};
  const auto add = [&](const auto& taps) { all.insert(all.end(), taps.begin(), taps.end()); };
  add(step.b1_taps), add(step.b0_taps), add(step.b1_mid), add(step.b0_mid);
  add(step.b1_rest), add(step.b0_rest);
  return all;
}

TEST(ModeStep, CarriesTheDerivativesByBothPoleParameters) {
  for (const Pole& pole : poles)
    for (const Hold hold : {Hold::first_order, Hold::zero_order, Hold::band_limited}) {
      const double fraction = hold == Hold::band_limited ? 0. : 0.3;
      const auto at = [&](double a1, double a0) {
        return numbers(ModeStep(a1, a0, rate_hz, hold, fraction));
      };
      const double h1 = 1e-5 * (pole.a1() + std::sqrt(pole.a0())), h0 = 1e-5 * pole.a0();
      const auto here = at(pole.a1(), pole.a0());
      const auto up1 = at(pole.a1() + h1, pole.a0()), down1 = at(pole.a1() - h1, pole.a0());
      const auto up0 = at(pole.a1(), pole.a0() + h0), down0 = at(pole.a1(), pole.a0() - h0);
      for (std::size_t i = 0; i < here.size(); ++i) {
        const double size = std::abs(here[i].value) + 1e-12;
        EXPECT_NEAR(here[i].by_a1 * h1, (up1[i].value - down1[i].value) / 2., 1e-8 * size);
        EXPECT_NEAR(here[i].by_a0 * h0, (up0[i].value - down0[i].value) / 2., 1e-8 * size);
      }
    }
}

TEST(SampledDelay, SplitsADelayIntoWholeSamplesAndAFraction) {
  EXPECT_EQ(sampled_delay(0.004, 500.).shift, 2);
  EXPECT_EQ(sampled_delay(0.004, 500.).fraction, 0.);
  EXPECT_EQ(sampled_delay(-0.0013, 500.).shift, -1);
  EXPECT_NEAR(sampled_delay(-0.0013, 500.).fraction, 0.35, 1e-12);
}

}  // namespace
}  // namespace vibrissa::separation
