#include "separation/model/analytical_bvrm.h"

#include <gmock/gmock.h>

#include "separation/model/simulation.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const signals::Beam wire{0.09, 70e9 * 5.5550e-15, 1.704e-3, 0.027};

// Base moment of the undamped beam per base acceleration, from the solution of Y'''' = k^4 Y for
// the absolute motion, without modes:
//   Y = Y0 (cosh kz + cos kz) / 2 + A (cosh kz - cos kz) + B (sinh kz - sin kz),
// clamped at z = 0 to the base, Y0 = -1 / w^2, free at z = H; the moment is EI Y''(0).
double undamped_moment_per_acceleration(const signals::Beam& beam, double frequency_hz) {
  const double omega = 2. * std::numbers::pi * frequency_hz;
  const double k =
      std::pow(beam.mass_per_length_kg_m * omega * omega / beam.bending_stiffness_n_m2, 0.25);
  const double x = k * beam.length_m;
  const double ch = std::cosh(x), sh = std::sinh(x), c = std::cos(x), s = std::sin(x);
  const double base = -1. / (omega * omega);
  const double d = (ch + c) * (ch + c) - (sh + s) * (sh - s);
  const double r1 = -0.5 * base * (ch - c), r2 = -0.5 * base * (sh + s);
  const double a = (r1 * (ch + c) - r2 * (sh + s)) / d;
  return beam.bending_stiffness_n_m2 * 2. * a * k * k;
}

TEST(AnalyticalBvrm, IsTheBeamsResponseOffResonance) {
  signals::Beam beam = wire;
  beam.damping_ratio = 1e-9;
  const Bvrm model = beam_bvrm(beam, 12);
  const double f1 = model.modes[0].frequency_hz();
  for (const double f : {0.1 * f1, 0.7 * f1, 1.5 * f1, 4. * f1, 9. * f1}) {
    const double expected = undamped_moment_per_acceleration(beam, f);
    EXPECT_NEAR(response(model, std::vector{f})[0].real() / expected, 1., 1e-5) << f / f1;
  }
}

TEST(AnalyticalBvrm, IsTheReducedModelsResponseAlongAnyAxis) {
  signals::ReducedModel reduced = signals::beam_model(wire, 3);
  reduced.modes[1].participation = {0.01, 0.02, 0.};
  reduced.modes[1].moment_participation = {3e-4, 2e-4, 0.};
  reduced.axial_direction = {0.6, 0.8, 0.};
  const std::vector<double> f{0.5, 20., 37., 200., 400.};
  const auto expected = signals::base_response(reduced, f),
             found = response(reduced_bvrm(reduced), f);
  for (std::size_t i = 0; i < f.size(); ++i)
    EXPECT_LT(std::abs(found[i] / expected[i] - 1.), 1e-12) << f[i];
}

TEST(AnalyticalBvrm, SimulatesAsTheReducedModelDoes) {
  const auto input = test::white_noise(2000, 3., 1);
  const auto expected =
      signals::simulate(signals::beam_model(wire, 3), {1000., input.size(), input}).base_moment;
  const auto moment = simulate(beam_bvrm(wire, 3), input, 1000.);
  EXPECT_LT(test::rms(test::minus(moment, expected)), 1e-9 * test::rms(expected));
}

TEST(AnalyticalBvrm, RefusesAnUndampedBeam) {
  signals::Beam beam = wire;
  beam.damping_ratio = 0.;
  EXPECT_THAT(
      [&] { beam_bvrm(beam, 2); },
      ThrowsMessage<signals::UserError>(HasSubstr("mode 1 of the reduced model is undamped")));
}

}  // namespace
}  // namespace vibrissa::separation
