#include "signals/model/beam_model.h"

#include <gmock/gmock.h>

#include <cmath>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

const Beam wire{0.09, 70e9 * 5.5550e-15, 1.704e-3, 0.02};

TEST(BeamModel, HasTheTabulatedRootsAndShapeFactors) {
  EXPECT_NEAR(cantilever_root(1), 1.8751, 5e-5);
  EXPECT_NEAR(cantilever_root(2), 4.6941, 5e-5);
  EXPECT_NEAR(cantilever_root(3), 7.8548, 5e-5);
  EXPECT_NEAR(cantilever_sigma(1), 0.7341, 5e-5);
  EXPECT_NEAR(cantilever_sigma(2), 1.0185, 5e-5);
  EXPECT_NEAR(cantilever_sigma(3), 0.9992, 5e-5);
}

TEST(BeamModel, StaticMomentOfAllModesIsHalfTheMassTimesTheLength) {
  double sum = 0.;
  for (std::size_t n = 1; n <= 2000; ++n) {
    sum += 4. * cantilever_sigma(n) / std::pow(cantilever_root(n), 3);
  }
  EXPECT_NEAR(sum, 0.5, 1e-7);
}

TEST(BeamModel, EffectiveMassOfAllModesIsTheMass) {
  double sum = 0.;
  for (std::size_t n = 1; n <= 20000; ++n) {
    sum += std::pow(2. * cantilever_sigma(n) / cantilever_root(n), 2);
  }
  // The tail of sum (2 / ((n - 1/2) pi))^2 beyond N is 4 / (pi^2 N).
  EXPECT_NEAR(sum + 4. / (M_PI * M_PI * 20000.), 1., 1e-8);
}

TEST(BeamModel, MomentParticipationComesFromTheCurvatureAtTheClamp) {
  const ReducedModel model = beam_model(wire, 3);
  for (std::size_t n = 1; n <= 3; ++n) {
    const double omega = 2. * M_PI * model.modes[n - 1].frequency_hz;
    const double beta = cantilever_root(n) / wire.length_m;
    const double curvature =
        2. * beta * beta / std::sqrt(wire.mass_per_length_kg_m * wire.length_m);
    EXPECT_NEAR(model.modes[n - 1].moment_participation[1],
                wire.bending_stiffness_n_m2 * curvature / (omega * omega),
                1e-10 * model.modes[n - 1].moment_participation[1]);
  }
}

TEST(BeamModel, QuasiStaticBaseMomentIsMinusHalfTheMassTimesTheLengthWhateverTheModes) {
  const double expected = -0.5 * wire.mass_per_length_kg_m * std::pow(wire.length_m, 2);
  for (const std::size_t n_modes : {1, 3}) {
    const std::vector<double> low{1e-3};
    const auto response = base_response(beam_model(wire, n_modes), low);
    EXPECT_NEAR(response.front().real(), expected, 1e-6 * std::abs(expected));
  }
}

TEST(BeamModel, RefusesDimensionsThatAreNotPositive) {
  Beam bad = wire;
  bad.length_m = 0.;
  EXPECT_THAT([&] { beam_model(bad, 1); },
              testing::ThrowsMessage<UserError>(testing::HasSubstr("length")));
  EXPECT_THAT([&] { beam_model(wire, 0); },
              testing::ThrowsMessage<UserError>(testing::HasSubstr("at least one mode")));
}

}  // namespace
}  // namespace vibrissa::signals
