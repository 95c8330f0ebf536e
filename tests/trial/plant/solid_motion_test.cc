#include "trial/plant/solid_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "signals/base/error.h"
#include "trial/generator/unexplained_change.h"
#include "trial/generator/unknowns.h"
#include "trial/plant/modal_motion.h"

namespace vibrissa::trial {
namespace {

constexpr double duration_s = 0.3, from_s = 0.15;

/// Motion of a stage with two frequencies around the resonance and a smooth start.
double stage(double t) {
  const double rise = 0.5 * (1. - std::cos(std::numbers::pi * std::min(1., t / 0.1)));
  return rise * (2. * std::sin(2. * std::numbers::pi * 20. * t) +
                 std::sin(2. * std::numbers::pi * 45. * t));
}
double gust(double t) {
  return 1.5 + 0.5 * std::sin(2. * std::numbers::pi * 10. * t);
}

/// The moment at both motions' common instants, after the beginning has decayed.
std::vector<double> moment(Motion& motion, double stage_share, double wind_share) {
  std::vector<double> a, u, out;
  const auto n = static_cast<std::size_t>(duration_s * motion.fine_hz());
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / motion.fine_hz();
    a.push_back(stage_share * stage(t));
    u.push_back(wind_share * gust(t));
  }
  const std::vector<double> all = motion.base_moment(a, u, 1);
  const std::size_t steps = motion.steps_per_sample();
  for (auto i = static_cast<std::size_t>(from_s * rate_hz); i * steps < all.size(); ++i)
    out.push_back(all[i * steps]);
  return out;
}

double distance(const std::vector<double>& x, const std::vector<double>& from) {
  double difference = 0., power = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) {
    difference += (x[i] - from[i]) * (x[i] - from[i]);
    power += from[i] * from[i];
  }
  return std::sqrt(difference / power);
}

TEST(SolidMotion, OfASmallStrokeIsThatOfTheModes) {
  const World world;
  ModalMotion modes(structure_of(world.solid), world);
  SolidMotion solid(world);
  EXPECT_LT(distance(moment(solid, 0.1, 0.), moment(modes, 0.1, 0.)), 0.005);
}

TEST(SolidMotion, FeelsTheWindAsTheModesDo) {
  const World world;
  ModalMotion modes(structure_of(world.solid), world);
  SolidMotion solid(world);
  EXPECT_LT(distance(moment(solid, 0., 1.), moment(modes, 0., 1.)), 0.005);
}

std::vector<double> moment_of_modes(const World& world) {
  ModalMotion modes(structure_of(world.solid), world);
  return moment(modes, 1., 0.);
}

TEST(LongSolidMotion, ChangesWithItsSolidAsTheModesDo) {
  const std::vector<double> before = moment_of_modes({});
  for (const auto& [id, size] : {std::pair("stiffness", -0.2), std::pair("mass", 0.2),
                                 std::pair("damping", 0.5), std::pair("viscoelastic", 0.3)}) {
    World world;
    find_unknown(id).apply(world, size, 0.5);
    SolidMotion solid(world);
    const std::vector<double> after = moment_of_modes(world);
    const double change = distance(after, before);
    ASSERT_GT(change, 0.1) << id;
    EXPECT_LT(distance(moment(solid, 1., 0.), after), 0.05 * change) << id;
  }
}

TEST(SolidMotion, RefusesWhatIsNoSolid) {
  World loose;
  find_unknown("joint_friction").apply(loose, 0.1, 0.5);
  EXPECT_FALSE(is_of_the_solid(loose));
  EXPECT_THROW(SolidMotion{loose}, signals::UserError);
}

}  // namespace
}  // namespace vibrissa::trial
