#include "trial/generator/signature.h"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <numbers>
#include <random>

#include "trial/generator/detection_limit.h"
#include "trial/generator/record_set.h"
#include "trial/generator/simulation_form.h"
#include "trial/plant/plant.h"

namespace vibrissa::trial {
namespace {

World plain() {
  World world;
  world.joint.scale = usual_turn;
  world.moment_noise = 1e-6;
  world.acceleration_noise = 0.04;
  return world;
}

Session base_only() {
  return {.takes = takes_of(RecordSet::base_only)};
}

TEST(WidenedNoise, IsTheCovarianceWithTheUnknownChanges) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto drawn = [&] {
    LineChange out{.moment = {}};
    for (int i = 0; i < 4; ++i) out.moment.emplace_back(normal(random), normal(random));
    return out;
  };
  const std::vector<double> noise{1., 2., 0.5, 3.};
  const std::vector<LineChange> unknown{drawn(), drawn()};
  const Eigen::VectorXd x = signature_of(drawn(), noise);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(x.size(), x.size());
  for (const LineChange& change : unknown) {
    const Eigen::VectorXd n = signature_of(change, noise);
    covariance += n * n.transpose();
  }
  EXPECT_NEAR(WidenedNoise(unknown, noise).whitened(x).squaredNorm(),
              x.dot(covariance.llt().solve(x)), 1e-10);
}

TEST(LikelihoodRatio, AllowsForTheAccuracyOfTheSimulation) {
  // A form that is 3 % off is thousands of nats against white noise, and no finding for a test that
  // knows of 3 %.
  const World world = plain();
  const UnexplainedChange change(world, base_only());
  const std::vector<double> noise = change.noise(world.moment_noise, world.acceleration_noise);
  const WidenedNoise widened(unknown_changes(change, Distance::exact, 0.03), noise);
  const Structure& sensor = structure_of(world.solid);
  const std::vector<std::complex<double>> base = change.by_base();
  // The response of another form in place of the sensor's, at each line.
  const auto response = [&](const Structure& structure, double frequency_hz) {
    return make_plant(structure, world)
        .response({0., 2. * std::numbers::pi * frequency_hz})(output::moment, input::acceleration);
  };
  const Structure other = draw_form(sensor, 0.03, 12345).structure;
  LineChange difference{.moment = base};
  for (std::size_t i = 0; i < base.size(); ++i) {
    const double f = change.frequencies_hz()[i];
    difference.moment[i] *= response(other, f) / response(sensor, f) - 1.;
  }
  const Eigen::VectorXd signature = signature_of(difference, noise);
  EXPECT_GT(signature.squaredNorm(), 2000.);
  EXPECT_LT(widened.whitened(signature).squaredNorm(), 0.05 * signature.squaredNorm());
}

TEST(DetectionLimit, RisesWithWhatIsUnknown) {
  const auto limit = [](Distance distance, double accuracy) {
    return detection_limit(LikelihoodRatio(plain(), base_only(), distance, accuracy),
                           find_unknown("delay"), 1., 0.5)
        .value();
  };
  const double exact = limit(Distance::exact, 0.), usual = limit(Distance::exact, 0.01);
  EXPECT_EQ(limit(Distance::as_built, 0.), exact) << "one definition for both";
  EXPECT_GT(limit(Distance::as_paper, 0.01), exact);
  EXPECT_GT(usual, 2. * exact);
  EXPECT_GT(limit(Distance::exact, 0.03), 2. * usual);
}

}  // namespace
}  // namespace vibrissa::trial
