// What the two fits of records in time have in common.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "separation/identification/output_error.h"
#include "separation/identification/srivc.h"
#include "tests/separation/fitted_models.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::disturbed;
using test::expect_equal_models;
using test::Signal;

using test::rate_hz;

struct Method {
  std::string name;
  std::function<FittedBvrm(const Bvrm&, const Segment&, Hold, const Nuisance&)> refine;
};

class TimeDomainFit : public testing::TestWithParam<Method> {
 protected:
  FittedBvrm refine(const Bvrm& start, const Segment& segment, Hold hold,
                    const Nuisance& nuisance = {}) const {
    return GetParam().refine(start, segment, hold, nuisance);
  }
};

TEST_P(TimeDomainFit, RecoversOneToThreeModesAndTheDirectTermFromACleanRecord) {
  const std::vector<ModalState> states{{1e-3, 0.1}, {-2e-4, 0.05}, {1e-4, -0.02}};
  const Signal input = test::white_noise(3000, 3., 1);
  for (std::size_t n_modes = 1; n_modes <= 3; ++n_modes)
    for (const Hold hold : {Hold::first_order, Hold::zero_order, Hold::band_limited})
      for (const double delay_s : {0., 0.0027, -0.004}) {
        Bvrm truth = test::sensor(n_modes, -2e-7);
        truth.delay_s = delay_s;
        Signal output = simulate(truth, input, rate_hz, hold, std::span(states).first(n_modes));
        for (double& m : output) m += 2e-5;
        const FittedBvrm fit = refine(disturbed(truth), {input, output}, hold);
        EXPECT_EQ(fit.end, FitEnd::converged);
        EXPECT_EQ(fit.model.delay_s, delay_s);
        expect_equal_models(fit, truth, 1e-7);
      }
}

TEST_P(TimeDomainFit, KnowsASensorAtRestWhenItIsTold) {
  const Signal input = test::white_noise(300, 3., 2);
  const Bvrm truth = test::sensor(1, -2e-7);
  for (const Hold hold : {Hold::first_order, Hold::zero_order, Hold::band_limited}) {
    const Signal output = simulate(truth, input, rate_hz, hold);
    const Nuisance at_rest{.initial_state = false, .offset = false};
    expect_equal_models(refine(disturbed(truth), {input, output}, hold, at_rest), truth, 1e-8);
    // The same without saying so: fewer samples are left for the model.
    expect_equal_models(refine(disturbed(truth), {input, output}, hold), truth, 1e-7);
  }
}

template <typename Options>
Method method(const std::string& name,
              FittedBvrm (*refine)(const Bvrm&, std::span<const Segment>, double, const Options&)) {
  return {name,
          [refine](const Bvrm& start, const Segment& segment, Hold hold, const Nuisance& nuisance) {
            Options options;
            options.hold = hold;
            options.nuisance = nuisance;
            return refine(start, std::span(&segment, 1), rate_hz, options);
          }};
}

INSTANTIATE_TEST_SUITE_P(Methods, TimeDomainFit,
                         testing::Values(method<OutputErrorOptions>("OutputError",
                                                                    refine_output_error),
                                         method<SrivcOptions>("Srivc", refine_srivc)),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace vibrissa::separation
