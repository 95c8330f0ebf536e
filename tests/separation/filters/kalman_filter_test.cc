#include "separation/filters/kalman_filter.h"

#include <gmock/gmock.h>

#include <functional>

#include "signals/base/error.h"
#include "tests/separation/path_signals.h"
#include "tests/separation/separator_checks.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(PartitionedKalman, ComesNearTheLeastSquaresLimitOnWhiteAndColouredInput) {
  constexpr std::size_t n = 30000, n_taps = 400;
  const Signal taps = test::decaying_taps(n_taps, 80., 2);
  for (const auto& [memory, within_db] : {std::pair{0., 3.}, std::pair{0.9, 6.}}) {
    const Signal x = test::coloured_noise(n, memory, 1), y = test::convolve(taps, x);
    const Signal d = test::plus_noise(y, test::rms(y) * std::pow(10., -1.5), 3);
    const double limit_db = test::misalignment_db(test::least_squares_taps(x, d, n_taps), taps);
    for (const std::size_t block : {20u, 64u, 200u}) {
      KalmanOptions options;
      options.block_length = block;
      options.filter_length = n_taps;
      PartitionedKalman filter(options);
      test::run(filter, x, d);
      const double found_db = test::misalignment_db(filter.impulse_response(), taps);
      EXPECT_LT(found_db, limit_db + within_db) << memory << ", block " << block;
      RecordProperty("above_limit_db_" + std::to_string(block) + (memory > 0. ? "_ar" : "_white"),
                     std::to_string(found_db - limit_db));
    }
  }
}

TEST(PartitionedKalman, FollowsAChangeOnlyWhenItsTransitionIsBelowOne) {
  const Signal before = test::decaying_taps(60, 20., 4), after = test::decaying_taps(60, 20., 5);
  const Signal x = test::white_noise(24000, 1., 6);
  Signal d = test::convolve(before, x);
  const Signal changed = test::convolve(after, x);
  std::copy(changed.begin() + 12000, changed.end(), d.begin() + 12000);
  const Signal measured = test::plus_noise(d, 0.01 * test::rms(d), 7);
  const auto misalignment = [&](double transition) {
    KalmanOptions options;
    options.block_length = 16;
    options.filter_length = 60;
    options.transition = transition;
    PartitionedKalman filter(options);
    test::run(filter, x, measured);
    return test::misalignment_db(filter.impulse_response(), after);
  };
  EXPECT_LT(misalignment(0.999), -20.);
  EXPECT_GT(misalignment(1.), -10.);
}

TEST(PartitionedKalman, LearnsNothingFromGapsGivenAsZeros) {
  const Signal taps = test::decaying_taps(60, 20., 8);
  const Signal x = test::white_noise(20000, 1., 9), y = test::convolve(taps, x);
  Signal d = test::plus_noise(y, 0.01 * test::rms(y), 10);
  std::fill(d.begin(), d.begin() + 3200, 0.);
  std::fill(d.begin() + 12800, d.begin() + 16000, 0.);
  KalmanOptions options;
  options.block_length = 32;
  options.filter_length = 60;
  PartitionedKalman filter(options);
  test::run(filter, x, d);
  EXPECT_LT(test::misalignment_db(filter.impulse_response(), taps), -45.);
}

TEST(PartitionedKalman, LearnsWhenTheMomentComesLongAfterTheAcceleration) {
  const Signal taps = test::decaying_taps(60, 20., 11);
  const Signal x = test::white_noise(20000, 1., 12), y = test::convolve(taps, x);
  Signal d = test::plus_noise(y, 0.01 * test::rms(y), 13);
  for (std::size_t i = 0; i < 6000; ++i) d[i] = 1e-12 * y[(i * 7) % 6000];
  KalmanOptions options;
  options.block_length = 32;
  options.filter_length = 60;
  PartitionedKalman filter(options);
  test::run(filter, x, d);
  EXPECT_LT(test::misalignment_db(filter.impulse_response(), taps), -40.);
}

TEST(PartitionedKalman, GivesTheSameAgainAfterAReset) {
  const Signal x = test::white_noise(2000, 2., 15), d = test::white_noise(2000, 2., 16);
  PartitionedKalman filter(KalmanOptions{});
  const Signal first = test::run(filter, x, d);
  filter.reset();
  EXPECT_EQ(test::run(filter, x, d), first);
}

TEST(PartitionedKalman, RefusesOptionsOutOfRange) {
  const auto refuse = [](const std::function<void(KalmanOptions&)>& spoil,
                         const std::string& message) {
    KalmanOptions options;
    spoil(options);
    EXPECT_THAT([&] { PartitionedKalman filter(options); },
                ThrowsMessage<UserError>(HasSubstr(message)));
  };
  refuse([](KalmanOptions& o) { o.block_length = 0; }, "block_length = 0");
  refuse([](KalmanOptions& o) { o.filter_length = 0; }, "filter_length = 0");
  refuse([](KalmanOptions& o) { o.transition = 0.; }, "transition = 0");
  refuse([](KalmanOptions& o) { o.transition = 1.5; }, "transition = 1.5");
  refuse([](KalmanOptions& o) { o.noise_forgetting = 1.; }, "noise_forgetting = 1");
}

}  // namespace
}  // namespace vibrissa::separation
