#include "separation/identification/srivc.h"

#include <gmock/gmock.h>

#include "separation/identification/output_error.h"
#include "signals/base/error.h"
#include "signals/spectra/frequency_response.h"
#include "tests/separation/fitted_models.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::disturbed;
using test::expect_equal_models;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

using test::rate_hz;

TEST(Srivc, FitsAModelWithoutADirectTerm) {
  const Bvrm truth = test::sensor(2);
  const Signal input = test::white_noise(2000, 3., 2), output = simulate(truth, input, rate_hz);
  const Segment segment{input, output};
  expect_equal_models(
      refine_srivc(disturbed(truth), std::span(&segment, 1), rate_hz, {.direct_term = false}),
      truth, 1e-8);
}

// Both have the same answer where the noise on the moment is white: the stationary point of the
// output error. SRIVC reaches it by linear steps that share no formula with Gauss and Newton's.
TEST(Srivc, EndsWhereTheOutputErrorFitEnds) {
  const Bvrm truth = test::sensor(2, -2e-7);
  std::vector<Signal> inputs, outputs;
  std::vector<Segment> segments;
  for (const std::uint64_t seed : {1u, 2u}) {
    inputs.push_back(test::white_noise(1500 + 500 * seed, 3., seed));
    const Signal clean = simulate(truth, inputs.back(), rate_hz);
    outputs.push_back(test::plus_noise(clean, 0.1 * test::rms(clean), 10 + seed));
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) segments.push_back({inputs[i], outputs[i]});
  const FittedBvrm srivc = refine_srivc(disturbed(truth), segments, rate_hz);
  const FittedBvrm output_error = refine_output_error(disturbed(truth), segments, rate_hz);
  EXPECT_EQ(srivc.end, FitEnd::converged);
  for (std::size_t k = 0; k < 2; ++k) {
    const Estimate &f = srivc.modes[k].frequency_hz, &expected = output_error.modes[k].frequency_hz;
    EXPECT_NEAR(f.value, expected.value, 0.01 * expected.standard_deviation);
    EXPECT_NEAR(f.standard_deviation / expected.standard_deviation, 1., 1e-3);
  }
  EXPECT_NEAR(srivc.residual_variance / output_error.residual_variance, 1., 1e-6);
}

TEST(Srivc, StartsFromAFrequencyResponse) {
  const Bvrm truth = test::sensor(2, -2e-7);
  const Signal input = test::white_noise(10000, 3., 4), output = simulate(truth, input, rate_hz);
  const Segment segment{input, output};
  expect_equal_models(
      refine_srivc(signals::welch_response(input, output, rate_hz, {.segment_samples = 1024}), 4,
                   std::span(&segment, 1), rate_hz),
      truth, 1e-6);
}

TEST(Srivc, RefusesWhatItCannotFit) {
  const Signal input = test::white_noise(100, 3., 12), output(100, 0.5);
  const Bvrm model = test::sensor(2);
  const auto fit = [&](const Bvrm& start, const Signal& u, const Signal& y, double rate = rate_hz) {
    const Segment segment{u, y};
    return refine_srivc(start, std::span(&segment, 1), rate);
  };
  EXPECT_THAT([&] { fit(model, input, Signal(99, 0.)); },
              ThrowsMessage<UserError>(HasSubstr("segment 1 has 100 samples")));
  EXPECT_THAT([&] { fit(model, Signal(20, 1.), Signal(20, 1.)); },
              ThrowsMessage<UserError>(HasSubstr("20 samples are too few for 14 unknowns")));
  EXPECT_THAT([&] { fit(model, input, output, 300.); },
              ThrowsMessage<UserError>(HasSubstr("above half the sampling rate")));
  EXPECT_THAT([&] { fit(model, input, output, -1.); },
              ThrowsMessage<UserError>(HasSubstr("rate -1")));
}

TEST(Srivc, SaysWhenNothingMoves) {
  const Signal input = test::white_noise(500, 3., 12);
  const Signal silent(500, 0.);
  const Segment segment{silent, input};
  EXPECT_EQ(refine_srivc(test::sensor(1), std::span(&segment, 1), rate_hz).end,
            FitEnd::poor_excitation);
}

}  // namespace
}  // namespace vibrissa::separation
