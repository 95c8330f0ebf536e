#include "separation/nonlinear/nonlinear_c_header.h"

#include <gmock/gmock.h>

#include "separation/nonlinear/nonlinear_bank.h"
#include "separation/nonlinear/nonlinear_separator.h"
#include "signals/base/error.h"
#include "tests/separation/header_in_c.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

// Two modes; the first moves by some 3e-4 m under 3 m/s^2 rms, where each term bears some tenths of
// the linear force.
NonlinearBvrm joint_of_all_terms() {
  NonlinearBvrm model{.linear = test::sensor(2, -2e-7),
                      .mode = 0,
                      .law = {{.kind = LawKind::cubic_stiffness, .coefficient = 2e10},
                              {.kind = LawKind::quadratic_stiffness, .coefficient = -1e6},
                              {.kind = LawKind::quadratic_damping, .coefficient = 50.},
                              {.kind = LawKind::friction, .coefficient = 0.5, .speed_m_s = 0.01},
                              {.kind = LawKind::monomial,
                               .coefficient = 1e8,
                               .deflection_power = 2,
                               .velocity_power = 1}}};
  model.largest_deflection_m = 1e-3;
  model.largest_speed_m_s = 0.2;
  return model;
}

// Rounding as in the linear header (see c_header_test.cc); the Runge-Kutta steps add some.
TEST(NonlinearCHeader, RunsInCAsTheSimulationDoesToSinglePrecision) {
  for (const LawReadout readout : {LawReadout::moment, LawReadout::deflection})
    for (const Hold hold : {Hold::first_order, Hold::zero_order})
      for (const double delay_s : {0., 0.002, 0.0073}) {
        NonlinearBvrm tried = joint_of_all_terms();
        tried.readout = readout;
        tried.linear.delay_s = delay_s;
        const CHeaderOptions options{.sampling_rate_hz = 500., .hold = hold, .name = "sensor"};
        const Signal input = test::white_noise(3000, 3., 1);
        const Signal output = test::run_in_c(nonlinear_c_header(tried, options), input);
        ASSERT_EQ(output.size(), input.size());
        EXPECT_LT(test::largest_relative_error(output, simulate(tried, input, 500., hold)), 1e-5)
            << to_string(readout) << " " << to_string(hold) << " " << delay_s;
      }
}

// From the first sample to the last one, with the same lag.
TEST(NonlinearCHeader, RunsInCAsTheStreamDoesUnderBandLimitedInput) {
  for (const LawReadout readout : {LawReadout::moment, LawReadout::deflection})
    for (const double delay_s : {0., 0.002, 0.0073, 0.09}) {
      NonlinearBvrm tried = joint_of_all_terms();
      tried.readout = readout;
      tried.linear.delay_s = delay_s;
      const CHeaderOptions options{
          .sampling_rate_hz = 500., .hold = Hold::band_limited, .name = "sensor"};
      const Signal input = test::white_noise(3000, 3., 1);
      const Signal output = test::run_in_c(nonlinear_c_header(tried, options), input);
      ASSERT_EQ(output.size(), input.size());
      NonlinearSeparator stream(tried, 500., Hold::band_limited);
      EXPECT_EQ(stream.latency_samples(), 32u);
      Signal expected(input.size());
      stream.process(input, Signal(input.size(), 0.), expected);
      for (double& m : expected) m = -m;
      EXPECT_LT(test::largest_relative_error(output, expected), 1e-5)
          << to_string(readout) << " " << delay_s;
    }
}

TEST(NonlinearCHeader, StartsAgainAtRestWhereTheLawRunsAway) {
  NonlinearBvrm soft = joint_of_all_terms();
  soft.law = {{.kind = LawKind::cubic_stiffness, .coefficient = -1e11}};
  const CHeaderOptions options{.sampling_rate_hz = 500., .name = "sensor"};
  const Signal output =
      test::run_in_c(nonlinear_c_header(soft, options), test::white_noise(3000, 30., 2));
  ASSERT_EQ(output.size(), 3000u);
  for (const double m : output) ASSERT_TRUE(std::isfinite(m));
}

TEST(NonlinearCHeader, RefusesWhatAMicrocontrollerCannotDo) {
  NonlinearBvrm tried = joint_of_all_terms();
  tried.linear.delay_s = -0.01;
  EXPECT_THAT([&] { nonlinear_c_header(tried, {.sampling_rate_hz = 500.}); },
              ThrowsMessage<UserError>(HasSubstr("leads")));
}

}  // namespace
}  // namespace vibrissa::separation
