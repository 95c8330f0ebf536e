#include "separation/model/simulation.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <numbers>

#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

using test::rate_hz;

// The same by classical Runge-Kutta with many small steps, for an input given at any time.
Signal integrate(const Bvrm& model, const std::function<double(double)>& input, std::size_t n,
                 std::vector<ModalState> states = {}) {
  constexpr int n_parts = 40;
  states.resize(model.modes.size());
  Signal moment;
  for (std::size_t i = 0; i < n; ++i) {
    const double time = static_cast<double>(i) / rate_hz;
    double sum = model.direct_term_kg_m * input(time);
    for (std::size_t k = 0; k < states.size(); ++k)
      sum += model.modes[k].b0 * states[k].position_m + model.modes[k].b1 * states[k].velocity_m_s;
    moment.push_back(sum);
    for (std::size_t k = 0; k < states.size(); ++k) {
      const ModalTerm& mode = model.modes[k];
      double x = states[k].position_m, v = states[k].velocity_m_s;
      const double h = 1. / (rate_hz * n_parts);
      for (int part = 0; part < n_parts; ++part) {
        const double t = time + part * h;
        // Just inside the step, where a jump of the input has not come yet.
        const auto pull = [&](double at, double y, double w) {
          return input(at) - mode.a1 * w - mode.a0 * y;
        };
        const double begin = t + 1e-9 * h, middle = t + 0.5 * h, end = t + h - 1e-9 * h;
        const double k1 = pull(begin, x, v), w1 = v;
        const double k2 = pull(middle, x + 0.5 * h * w1, v + 0.5 * h * k1), w2 = v + 0.5 * h * k1;
        const double k3 = pull(middle, x + 0.5 * h * w2, v + 0.5 * h * k2), w3 = v + 0.5 * h * k2;
        const double k4 = pull(end, x + h * w3, v + h * k3), w4 = v + h * k3;
        x += h / 6. * (w1 + 2. * w2 + 2. * w3 + w4);
        v += h / 6. * (k1 + 2. * k2 + 2. * k3 + k4);
      }
      states[k] = {x, v};
    }
  }
  return moment;
}

std::function<double(double)> held(const Signal& samples, Hold hold, double delay_s = 0.) {
  return [=](double time) {
    const double place = std::max(0., (time - delay_s) * rate_hz);
    const auto i = std::min(static_cast<std::size_t>(place), samples.size() - 1);
    if (hold == Hold::zero_order || i + 1 == samples.size()) return samples[i];
    const double share = place - static_cast<double>(i);
    return (1. - share) * samples[i] + share * samples[i + 1];
  };
}

Bvrm rich_model() {
  Bvrm model = test::sensor(2, -2e-7);
  model.modes.push_back(make_modal_term(60., 1.7, 1e-6, 1e-9));  // two real poles
  return model;
}

TEST(Simulation, EqualsFineIntegrationOfTheHeldInput) {
  const Bvrm model = rich_model();
  const Signal input = test::white_noise(400, 2., 3);
  for (const Hold hold : {Hold::first_order, Hold::zero_order}) {
    const Signal moment = simulate(model, input, rate_hz, hold);
    const Signal fine = integrate(model, held(input, hold), input.size());
    EXPECT_LT(test::rms(test::minus(moment, fine)), 1e-5 * test::rms(fine)) << to_string(hold);
  }
}

TEST(Simulation, FollowsTheClosedFormOfAStep) {
  Bvrm model;
  model.modes = {make_modal_term(10., 0.1, 3e-6)};
  const Signal moment = simulate(model, Signal(300, 2.), rate_hz);
  const double omega = 20. * std::numbers::pi, damped = omega * std::sqrt(1. - 0.01);
  for (std::size_t i = 0; i < moment.size(); ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    const double expected =
        6e-6 * (1. - std::exp(-0.1 * omega * t) *
                         (std::cos(damped * t) + 0.1 * omega / damped * std::sin(damped * t)));
    EXPECT_NEAR(moment[i], expected, 1e-15) << i;
  }
}

TEST(Simulation, StartsFromTheGivenState) {
  const Bvrm model = rich_model();
  const std::vector<ModalState> states{{1e-3, 0.1}, {-2e-4, 0.05}, {1e-4, -0.02}};
  const Signal input = test::white_noise(200, 1., 4);
  for (const Hold hold : {Hold::first_order, Hold::zero_order}) {
    const Signal moment = simulate(model, input, rate_hz, hold, states);
    const Signal fine = integrate(model, held(input, hold), input.size(), states);
    EXPECT_LT(test::rms(test::minus(moment, fine)), 1e-5 * test::rms(fine)) << to_string(hold);
  }
}

TEST(Simulation, DelaysTheMomentByAnyTimeOfEitherSign) {
  const Signal input = test::white_noise(300, 2., 5);
  for (const double delay_s : {0.004, 0.0027, 0.0003, -0.002, -0.0033})
    for (const Hold hold : {Hold::first_order, Hold::zero_order}) {
      Bvrm model = rich_model();
      model.delay_s = delay_s;
      const Signal moment = simulate(model, input, rate_hz, hold);
      // The input before its first sample is taken as constant, with the sensor at rest until it
      // begins; a constant early input would move the sensor, so the reference begins there.
      const double start_s = std::max(0., std::ceil(delay_s * rate_hz)) / rate_hz;
      const auto skip = static_cast<std::size_t>(start_s * rate_hz + 0.5);
      Bvrm prompt = model;
      prompt.delay_s = 0.;
      const double advance = -delay_s;
      // Fine integration of the undelayed model, read at the delayed times.
      constexpr std::size_t oversampling = 20;
      Signal fine_input;
      for (std::size_t i = 0; i < input.size() * oversampling; ++i)
        fine_input.push_back(
            held(input, hold)(static_cast<double>(i) / (rate_hz * oversampling) + 1e-9));
      const Signal fine = simulate(prompt, fine_input, rate_hz * oversampling,
                                   hold == Hold::zero_order ? hold : Hold::first_order);
      Signal expected, actual;
      for (std::size_t i = skip + 1; i + 5 < input.size(); ++i) {
        const double place = (static_cast<double>(i) / rate_hz + advance) * rate_hz * oversampling;
        ASSERT_NEAR(place, std::round(place), 1e-6);
        expected.push_back(fine[static_cast<std::size_t>(std::llround(place))]);
        actual.push_back(moment[i]);
      }
      EXPECT_LT(test::rms(test::minus(actual, expected)), 1e-6 * test::rms(expected))
          << delay_s << " " << to_string(hold);
    }
}

TEST(Simulation, OfABandLimitedInputEqualsItsSteadyState) {
  const test::Lines lines(2., 210., 40, 6);
  for (const double delay_s : {0., 0.0013, -0.0027}) {
    Bvrm model = test::sensor(2, -2e-7);
    model.delay_s = delay_s;
    const std::size_t n = 1500;
    const Signal input = lines.sample(n, rate_hz), answer = lines.answer(model, n, rate_hz);
    const Signal moment = simulate_like(model, input, answer, rate_hz, Hold::band_limited);
    const auto inner = [](const Signal& x) { return std::span(x).subspan(200, 1100); };
    // InputShaper keeps each line within 0.1 %.
    EXPECT_LT(test::rms(test::minus(inner(moment), inner(answer))), 1e-3 * test::rms(answer))
        << delay_s;
    // Straight lines between the samples do not hold 210 Hz at 500 samples a second.
    const Signal coarse = simulate_like(model, input, answer, rate_hz, Hold::first_order);
    EXPECT_GT(test::rms(test::minus(inner(coarse), inner(answer))), 2e-2 * test::rms(answer));
  }
}

TEST(SimulationLike, FindsTheFreeResponseAndTheOffset) {
  const Bvrm model = rich_model();
  const std::vector<ModalState> states{{1e-3, 0.1}, {-2e-4, 0.05}, {1e-4, -0.02}};
  const Signal input = test::white_noise(600, 1., 7);
  for (const Hold hold : {Hold::first_order, Hold::zero_order}) {
    Signal measured = simulate(model, input, rate_hz, hold, states);
    for (double& m : measured) m += 3e-5;
    const Signal simulated = simulate_like(model, input, measured, rate_hz, hold);
    EXPECT_LT(test::rms(test::minus(simulated, measured)), 1e-11 * test::rms(measured));
    const Signal stiff = simulate_like(model, input, measured, rate_hz, hold,
                                       {.initial_state = false, .offset = false});
    EXPECT_GT(test::rms(test::minus(stiff, measured)), 1e-2 * test::rms(measured));
  }
}

TEST(Simulation, OfSilenceIsSilent) {
  EXPECT_THAT(simulate(rich_model(), Signal(1000, 0.), rate_hz), testing::Each(0.));
}

TEST(Simulation, RefusesWhatItCannotSimulate) {
  const Signal input(100, 1.);
  const Bvrm model = test::sensor(2);
  EXPECT_THAT([&] { simulate(model, input, 0.); }, ThrowsMessage<UserError>(HasSubstr("rate 0")));
  const std::vector<ModalState> states(1);
  EXPECT_THAT([&] { simulate(model, input, 500., Hold::first_order, states); },
              ThrowsMessage<UserError>(HasSubstr("1 initial states given for a model of 2")));
  Bvrm unstable = model;
  unstable.modes[0].a1 = 0.;
  EXPECT_THAT([&] { simulate(unstable, input, 500.); }, ThrowsMessage<UserError>(HasSubstr("a1")));
  EXPECT_THAT([&] { simulate_like(model, Signal(9, 1.), Signal(9, 1.), 500., Hold::first_order); },
              ThrowsMessage<UserError>(HasSubstr("9 samples is too short")));
  EXPECT_THAT([&] { simulate_like(model, input, Signal(99, 1.), 500., Hold::first_order); },
              ThrowsMessage<UserError>(HasSubstr("99")));
}

}  // namespace
}  // namespace vibrissa::separation
