#include "separation/model/c_header.h"

#include <gmock/gmock.h>

#include "separation/model/simulation.h"
#include "signals/base/error.h"
#include "tests/separation/header_in_c.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

Signal run_in_c(const Bvrm& model, const CHeaderOptions& options, const Signal& input) {
  return test::run_in_c(c_header(model, options), input);
}

using test::largest_relative_error;

// A state of single precision is rounded by up to 6e-8 of itself at every sample, and a mode
// remembers 1 / (zeta w) seconds of such errors, which add up as their root.
TEST(CHeader, RunsInCAsTheSimulationDoesToSinglePrecision) {
  Bvrm model = test::sensor(2, -2e-7);
  model.modes.push_back({.b1 = 2e-6, .b0 = -3e-4, .a1 = 60., .a0 = 500.});  // two real poles
  for (const Hold hold : {Hold::first_order, Hold::zero_order})
    for (const double delay_s : {0., 0.002, 0.0073}) {
      model.delay_s = delay_s;
      const Signal input = test::white_noise(3000, 3., 1);
      const Signal output =
          run_in_c(model, {.sampling_rate_hz = 500., .hold = hold, .name = "sensor"}, input);
      ASSERT_EQ(output.size(), input.size());
      EXPECT_LT(largest_relative_error(output, simulate(model, input, 500., hold)), 3e-6)
          << to_string(hold) << " " << delay_s;
    }
}

TEST(CHeader, KeepsItsAccuracyWhenTheSamplingIsFastAgainstTheMode) {
  const Bvrm model = test::sensor(1, -2e-7);
  const Signal input = test::white_noise(100000, 3., 2);
  const Signal output = run_in_c(model, {.sampling_rate_hz = 50000., .name = "sensor"}, input);
  ASSERT_EQ(output.size(), input.size());
  EXPECT_LT(largest_relative_error(output, simulate(model, input, 50000.)), 1e-4);
}

TEST(CHeader, RefusesWhatAMicrocontrollerCannotDo) {
  Bvrm model = test::sensor(1);
  const CHeaderOptions good{.sampling_rate_hz = 500.};
  const auto with = [&](auto change) {
    CHeaderOptions options = good;
    change(options);
    return c_header(model, options);
  };
  EXPECT_THAT([&] { with([](auto& o) { o.hold = Hold::band_limited; }); },
              ThrowsMessage<UserError>(HasSubstr("needs future samples")));
  EXPECT_THAT([&] { with([](auto& o) { o.sampling_rate_hz = 0.; }); },
              ThrowsMessage<UserError>(HasSubstr("sampling rate 0")));
  EXPECT_THAT([&] { with([](auto& o) { o.name = "my model"; }); },
              ThrowsMessage<UserError>(HasSubstr("not a C identifier")));
  model.delay_s = -0.01;
  EXPECT_THAT([&] { c_header(model, good); }, ThrowsMessage<UserError>(HasSubstr("leads")));
  EXPECT_THAT([&] { c_header({}, good); }, ThrowsMessage<UserError>(HasSubstr("no mode")));
}

}  // namespace
}  // namespace vibrissa::separation
