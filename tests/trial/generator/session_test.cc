#include "trial/generator/session.h"

#include <gtest/gtest.h>

#include "signals/model/base_velocity.h"
#include "trial/generator/detection_limit.h"

namespace vibrissa::trial {
namespace {

TEST(Session, TheAirFeelsHowTheBaseMoves) {
  // Far below its resonance the whisker moves with the base. In a steady wind u, with a share of
  // this velocity v in the relative wind, the moment changes by -2 share u v times that of u^2.
  constexpr double u = 3., share = 0.2;
  const Session session{.takes = {{.name = "slow",
                                   .base_rms = 2.,
                                   .wind_mean = u,
                                   .n_samples = 2048,
                                   .low_hz = 3.,
                                   .high_hz = 7.,
                                   .gustiness = 0.}},
                        .noise = false};
  World still, moving;
  moving.own_motion = share;
  const Structure& structure = structure_of(still.solid);
  const signals::Record without = record_session(structure, still, session).records.front().record,
                        with = record_session(structure, moving, session).records.front().record;
  const auto velocity =
      signals::base_velocity(without.channel(signals::channel::base_acceleration), rate_hz);
  const auto before = without.channel(signals::channel::base_moment),
             after = with.channel(signals::channel::base_moment);
  double product = 0., square = 0.;
  for (std::size_t i = 100; i + 100 < velocity.size(); ++i) {
    product += (after[i] - before[i]) * velocity[i];
    square += velocity[i] * velocity[i];
  }
  const double per_velocity = -2. * share * u * still.drag * structure.wind_moment;
  EXPECT_NEAR(product / square / per_velocity, 1., 0.1);
}

}  // namespace
}  // namespace vibrissa::trial
