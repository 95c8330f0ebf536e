#include "diagnosis/search/calibration_posterior.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <random>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using testing::Contains;
using testing::Not;

std::vector<std::string> needless(const signals::Dataset& dataset) {
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, true), dataset, signals::Split::fit,
                         InputNoise::reduced);
  return needless_calibrations(fit_hypothesis(experiment, Hypothesis{}));
}

signals::Dataset records_of(const test::OneModeRig& rig) {
  return test::rig_dataset(rig, {.wind = true});
}

signals::Dataset with_accelerometer_gain(signals::Dataset dataset, const double gain) {
  for (signals::DatasetRecord& entry : dataset.records) {
    const auto values = entry.record.channel(signals::channel::base_acceleration);
    std::vector<double> x(values.begin(), values.end());
    for (double& value : x) value *= gain;
    entry.record.set_channel(signals::channel::base_acceleration, std::move(x));
  }
  return dataset;
}

TEST(NeedlessCalibrations, AreAllWhereTheSensorIsAsSimulated) {
  EXPECT_EQ(needless(records_of(test::noisy_rig())).size(), nuisance_ids().size());
}

TEST(NeedlessCalibrations, AreNotTheOneThatMoved) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.8;
  const auto ids = needless(records_of(rig));
  EXPECT_THAT(ids, Not(Contains("stiffness")));
  EXPECT_THAT(ids, Contains("damping"));
}

// A gain of the sensor with one of the drag does the same to these records.
TEST(NeedlessCalibrations, AreTwoThatOneReplaces) {
  const auto ids = needless(with_accelerometer_gain(records_of(test::noisy_rig()), 1.05));
  EXPECT_THAT(ids, Not(Contains("reference_gain")));
  EXPECT_THAT(ids, testing::IsSupersetOf({"sensor_gain", "drag_error"}));
}

/// Base motion alone: the ratio of two gains shows, with this deviation, and the simulation's own
/// gain has another one.
struct GainsOfBaseMotion {
  double deviation = 0.001, own_error = 0.;

  static double true_shift(const Prior& prior, std::mt19937& random) {
    std::bernoulli_distribution is_off(0.5);
    std::cauchy_distribution<double> off(prior.centre, prior.scale);
    return is_off(random) ? off(random) : 0.;
  }

  /// The fit of a sensor; its true gain [log].
  std::pair<HypothesisFit, double> draw(const Experiment& experiment, std::mt19937& random) const {
    HypothesisFit fit;
    for (FitParameter& parameter : make_fit_parameters(experiment, Hypothesis{}))
      if (!parameter.nuisance ||
          (parameter.parameter == 0 &&
           (parameter.effect->id == "sensor_gain" || parameter.effect->id == "reference_gain")))
        fit.fit_parameters.push_back(parameter);
    const auto n = static_cast<Eigen::Index>(fit.fit_parameters.size());
    const auto sensor = static_cast<Eigen::Index>(*fit.index("sensor_gain", 0)),
               reference = static_cast<Eigen::Index>(*fit.index("reference_gain", 0));
    const Prior &of_sensor = prior(fit, sensor), &of_reference = prior(fit, reference);
    std::normal_distribution<double> normal;
    const double truth = true_shift(of_sensor, random);
    const double seen = truth - true_shift(of_reference, random) + own_error * normal(random) +
                        deviation * normal(random);
    fit.x = Eigen::VectorXd::Zero(n);
    const double weight = 1. / (deviation * deviation);
    for (int i = 0; i < 200; ++i) {
      Eigen::MatrixXd information = Eigen::MatrixXd::Identity(n, n);
      information(sensor, sensor) = weight + of_sensor.curvature(fit.x(sensor));
      information(reference, reference) = weight + of_reference.curvature(fit.x(reference));
      information(sensor, reference) = information(reference, sensor) = -weight;
      const double left = seen - fit.x(sensor) + fit.x(reference);
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
      gradient(sensor) = weight * left + of_sensor.slope(fit.x(sensor));
      gradient(reference) = -weight * left + of_reference.slope(fit.x(reference));
      fit.covariance = information.inverse();
      fit.x += fit.covariance * gradient;
    }
    return {std::move(fit), truth};
  }

 private:
  static const Prior& prior(const HypothesisFit& fit, Eigen::Index i) {
    return fit.fit_parameters[static_cast<std::size_t>(i)].description.prior;
  }
};

class CalibrationIntervals : public testing::Test {
 protected:
  /// Number of true gains in the intervals, of 400 sensors.
  int covered(const GainsOfBaseMotion& gains, const double simulation_accuracy) const {
    std::mt19937 random(5);
    int n = 0;
    for (int i = 0; i < 400; ++i) {
      const auto [fit, truth] = gains.draw(experiment_, random);
      const auto [low, high] = calibration_intervals(fit, simulation_accuracy).at("sensor_gain");
      n += low <= truth && truth <= high;
    }
    return n;
  }
  const Experiment experiment_ =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, true), records_of(test::noisy_rig()),
                         signals::Split::fit, InputNoise::reduced);
};

TEST_F(CalibrationIntervals, HoldTheGainThatAnotherGainHides) {
  EXPECT_GE(covered({}, 0.), 372);  // 380 less two standard deviations
}

TEST_F(CalibrationIntervals, AllowForTheGainOfTheSimulation) {
  const GainsOfBaseMotion gains{.own_error = 0.03};
  EXPECT_GE(covered(gains, 0.03), 372);
  EXPECT_LT(covered(gains, 0.), 372);
}

}  // namespace
}  // namespace vibrissa::diagnosis
