#include "separation/identification/order_selection.h"

#include <gmock/gmock.h>

#include "separation/model/simulation.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

using test::rate_hz;

struct Rig {
  Signal acceleration, moment;
  Segment segment() const { return {acceleration, moment}; }
};

// Noise as shares of the rms of each channel.
Rig measure(const Bvrm& truth, std::size_t n, double moment_noise, double accelerometer_noise,
            std::uint64_t seed) {
  const Signal motion = test::white_noise(n, 3., seed);
  const Signal moment = simulate(truth, motion, rate_hz);
  return {.acceleration = test::plus_noise(motion, accelerometer_noise * 3., 2 * seed + 1000),
          .moment = test::plus_noise(moment, moment_noise * test::rms(moment), 2 * seed + 1001)};
}

OrderSelection select(const Rig& rig, const OrderOptions& options = {}) {
  const Segment segment = rig.segment();
  return select_order(std::span(&segment, 1), rate_hz, options);
}

TEST(OrderSelection, FittedErrorNeverRisesWithTheOrder) {
  for (const std::size_t n_modes : {1u, 2u, 3u})
    for (const double accelerometer_noise : {0., 0.1})
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const Rig rig =
            measure(test::sensor(n_modes, -2e-7), 3000, 0.03, accelerometer_noise, seed);
        const OrderSelection selection = select(rig, {.max_order = 8, .fruitless_orders = 4});
        ASSERT_GE(selection.trials.size(), 2u);
        for (std::size_t i = 1; i < selection.trials.size(); ++i)
          EXPECT_LE(selection.trials[i].fitted_mean_square,
                    selection.trials[i - 1].fitted_mean_square * (1. + 1e-9))
              << n_modes << " modes, order " << selection.trials[i].order;
      }
}

// Starts from a response too coarse to show the modes lead astray now and then; the fit below does
// not.
TEST(OrderSelection, FittedErrorNeverRisesWhereTheResponseTellsLittle) {
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    const Rig rig = measure(test::sensor(3, -2e-7), 2000, 0.03, 0., seed);
    const Segment segment = rig.segment();
    const auto response =
        signals::welch_response(segment.base_acceleration.first(160),
                                segment.base_moment.first(160), rate_hz, {.segment_samples = 64});
    double below = std::numeric_limits<double>::infinity();
    for (const FittedBvrm& fit : fit_orders(response, std::span(&segment, 1), rate_hz, 8, 0., {})) {
      const auto n_unknowns = static_cast<double>(n_parameters(fit.model.modes.size(), true) +
                                                  2 * fit.model.modes.size() + 1);
      const double squares = fit.residual_variance * (2000. - n_unknowns);
      EXPECT_LE(squares, below * (1. + 1e-9)) << seed << ", order " << fit.model.order();
      below = squares;
    }
  }
}

struct Share {
  double cross_validation = 0., information = 0.;
};

// Share of 12 records for which the right order was found.
Share right(std::size_t n_modes, double moment_noise, double accelerometer_noise) {
  Share share;
  constexpr int n_draws = 12;
  for (std::uint64_t seed = 1; seed <= n_draws; ++seed) {
    const OrderSelection selection = select(
        measure(test::sensor(n_modes, -2e-7), 6000, moment_noise, accelerometer_noise, seed));
    share.cross_validation += (selection.by_cross_validation == 2 * n_modes) / double{n_draws};
    share.information += (selection.by_information == 2 * n_modes) / double{n_draws};
  }
  const std::string label = std::to_string(n_modes) + (accelerometer_noise > 0. ? "_noisy" : "");
  testing::Test::RecordProperty("cross_validation_" + label,
                                std::to_string(share.cross_validation));
  testing::Test::RecordProperty("information_" + label, std::to_string(share.information));
  return share;
}

TEST(OrderSelection, FindsTheOrderInWhiteNoise) {
  for (const std::size_t n_modes : {1u, 2u}) {
    const Share share = right(n_modes, 0.03, 0.);
    EXPECT_GE(share.cross_validation, 0.9) << n_modes;
    EXPECT_GE(share.information, 0.9) << n_modes;
  }
}

// The accelerometer's noise, carried through the model, is thirty times the noise of the moment and
// loud at the resonances.
TEST(OrderSelection, IsNotFooledByTheNoiseOfAnAccelerometer) {
  for (const std::size_t n_modes : {1u, 2u}) {
    const Share share = right(n_modes, 0.003, 0.1);
    EXPECT_GE(share.cross_validation, 0.9) << n_modes;
    EXPECT_GE(share.information, 0.9) << n_modes;
  }
}

TEST(OrderSelection, SaysWhatItFound) {
  EXPECT_THAT(select(measure(test::sensor(2, -2e-7), 8000, 0.03, 0., 1)).words,
              HasSubstr("both select order 4"));
}

TEST(OrderSelection, RefusesWhatCannotBeDone) {
  const Rig rig = measure(test::sensor(1), 1000, 0.03, 0., 1);
  EXPECT_THAT([&] { select(rig, {.max_order = 3}); },
              ThrowsMessage<UserError>(HasSubstr("max_order = 3 must be an even")));
  EXPECT_THAT([&] { select(rig, {.held_out_share = 1.}); },
              ThrowsMessage<UserError>(HasSubstr("held_out_share")));
  EXPECT_THAT([&] { select(measure(test::sensor(1), 300, 0.03, 0., 1)); },
              ThrowsMessage<UserError>(HasSubstr("300 samples is too short")));
  EXPECT_THAT([&] { select_order({}, rate_hz); },
              ThrowsMessage<UserError>(HasSubstr("no segment")));
}

}  // namespace
}  // namespace vibrissa::separation
