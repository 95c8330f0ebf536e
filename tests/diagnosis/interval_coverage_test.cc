#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <thread>

#include "diagnosis/diagnosis.h"
#include "one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// Shares of 200 sensors and simulations, which differ in noise and joint, for which an interval of
/// 95 % holds the truth.
struct Coverage {
  int n = 0, delay = 0, stiffness = 0, gap_closed = 0;
};

/// One sensor, softer and late, with noise of its own seed; the right hypothesis is fitted.
void add_trial(unsigned seed, Coverage& out) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.93;
  rig.delay_s = 5e-4;
  const signals::Dataset real = test::rig_dataset(rig, {.seed = 1000 + 97 * seed});
  NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  // The simulation is as wrong about the joint as it says that it may be; none holds more than all
  // of the compliance.
  std::mt19937 random(seed);
  nominal.joint_share -=
      std::abs(std::normal_distribution<double>(0., nominal.joint_share_deviation)(random));
  const Experiment fit_records =
      prepare_experiment(nominal, real, signals::Split::fit, InputNoise::reduced);
  const Experiment held_out =
      prepare_experiment(nominal, real, signals::Split::held_out, InputNoise::as_measured);
  const HypothesisFit fit =
      fit_hypothesis(fit_records, Hypothesis({&find_effect("delay"), &find_effect("stiffness")}));
  out.n += 1;
  for (const ParameterEstimate& estimate : parameter_estimates(fit, "delay+stiffness")) {
    if (estimate.name == "damping_exponent") continue;  // the rig knows none
    const double truth = estimate.effect == "delay" ? rig.delay_s : rig.stiffness;
    const bool covered = estimate.ci95[0] <= truth && truth <= estimate.ci95[1];
    (estimate.effect == "delay" ? out.delay : out.stiffness) += covered;
  }
  // The right model closes the gap down to the noise.
  const ErrorScore score = score_held_out(fit_records, held_out, fit, {.seed = seed}).overall;
  if (score.gap_closed_ci95)
    out.gap_closed += (*score.gap_closed_ci95)[0] <= 1. && 1. <= (*score.gap_closed_ci95)[1];
}

TEST(Intervals, HoldTheTruthAsOftenAsTheySay) {
  constexpr unsigned n_trials = 200;
  Coverage halves[2];
  std::thread other([&] {
    for (unsigned seed = 1; seed < n_trials; seed += 2) add_trial(seed, halves[1]);
  });
  for (unsigned seed = 0; seed < n_trials; seed += 2) add_trial(seed, halves[0]);
  other.join();
  const auto share = [&](int Coverage::*part) {
    return static_cast<double>(halves[0].*part + halves[1].*part) / n_trials;
  };
  for (const auto& [name, part] :
       {std::pair{"delay", &Coverage::delay}, std::pair{"stiffness", &Coverage::stiffness},
        std::pair{"gap_closed", &Coverage::gap_closed}}) {
    RecordProperty(name, std::to_string(share(part)));
    EXPECT_GE(share(part), 0.90) << name;
    EXPECT_LE(share(part), 0.98) << name;
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
