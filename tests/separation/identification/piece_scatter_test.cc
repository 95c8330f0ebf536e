#include "separation/identification/piece_scatter.h"

#include <gmock/gmock.h>

#include "separation/model/simulation.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::rate_hz;
using test::Signal;
using testing::HasSubstr;

struct MovingSensor {
  Signal motion, moment;
  Segment segment() const { return {motion, moment}; }
};

// The resonance of the last third is shifted by this share.
MovingSensor moving_sensor(double shift, std::uint64_t seed) {
  constexpr std::size_t n = 6000;
  MovingSensor sensor{.motion = test::white_noise(n, 3., seed), .moment = {}};
  const Bvrm first{.modes = {make_modal_term(31.47, 0.027, -9e-6)}};
  const Bvrm last{.modes = {make_modal_term(31.47 * (1. + shift), 0.027, -9e-6)}};
  sensor.moment = simulate(first, sensor.motion, rate_hz);
  const Signal other = simulate(last, sensor.motion, rate_hz);
  std::copy(other.begin() + 2 * n / 3, other.end(), sensor.moment.begin() + 2 * n / 3);
  sensor.moment = test::plus_noise(sensor.moment, 0.05 * test::rms(sensor.moment), seed + 100);
  return sensor;
}

struct TwoDeviations {
  double stated_hz, widened_hz;
  std::string words;
};

TwoDeviations deviations(const MovingSensor& sensor) {
  const Segment segment = sensor.segment();
  const OutputErrorOptions options{.direct_term = false, .viscous_term = false};
  const Bvrm start{.modes = {make_modal_term(31.47, 0.027, -9e-6)}};
  const FittedBvrm fit = refine_output_error(start, std::span(&segment, 1), rate_hz, options);
  const ScatteredFit widened = widen_by_scatter(fit, std::span(&segment, 1), rate_hz, options);
  EXPECT_EQ(widened.fit.model.modes[0].a0, fit.model.modes[0].a0) << "the model is the same";
  return {fit.modes[0].frequency_hz.standard_deviation,
          widened.fit.modes[0].frequency_hz.standard_deviation, widened.words};
}

TEST(PieceScatter, LeavesASensorAloneThatStaysTheSame) {
  int widened = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TwoDeviations found = deviations(moving_sensor(0., seed));
    EXPECT_GE(found.widened_hz, found.stated_hz);
    widened += found.widened_hz > found.stated_hz;
  }
  EXPECT_LE(widened, 6) << "one in a hundred by chance";
}

TEST(PieceScatter, CoversAResonanceThatMoves) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const TwoDeviations found = deviations(moving_sensor(0.01, seed));
    EXPECT_GT(found.widened_hz, 0.05) << "the resonance moved by 0.31 Hz in a third of the record";
    EXPECT_LT(found.stated_hz, 0.01);
    EXPECT_THAT(found.words, HasSubstr("frequency"));
    EXPECT_THAT(found.words, HasSubstr("31."));
  }
}

TEST(PieceScatter, KeepsAFitWhosePiecesAreTooShort) {
  MovingSensor sensor = moving_sensor(0., 9);
  sensor.motion.resize(60);
  sensor.moment.resize(60);
  const TwoDeviations found = deviations(sensor);
  EXPECT_EQ(found.widened_hz, found.stated_hz);
}

}  // namespace
}  // namespace vibrissa::separation
