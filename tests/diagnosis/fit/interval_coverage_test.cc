#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

#include "diagnosis/diagnosis.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// Coverage of 95 % intervals for 200 sensors with lower stiffness and a delay.
struct Coverage {
  int delay = 0, stiffness = 0, gap_closed = 0;
};

/// A sensor with its own noise seed; the correct hypothesis is fitted.
struct Trial {
  Experiment fit_records, held_out;
  HypothesisFit fit;

  Trial(const NominalModel& nominal, unsigned seed)
      : Trial(nominal, test::rig_dataset(rig(), {.seed = 1000 + 97 * seed})) {}

  static test::OneModeRig rig() {
    test::OneModeRig rig = test::noisy_rig();
    rig.stiffness = 0.93;
    rig.delay_s = 5e-4;
    return rig;
  }
  bool holds(const std::string& effect, double truth) const {
    for (const ParameterEstimate& estimate : parameter_estimates(fit, "delay+stiffness"))
      if (estimate.effect == effect) return estimate.ci95[0] <= truth && truth <= estimate.ci95[1];
    return false;
  }

 private:
  Trial(const NominalModel& nominal, const signals::Dataset& real)
      : fit_records(prepare_experiment(nominal, real, signals::Split::fit, InputNoise::reduced)),
        held_out(
            prepare_experiment(nominal, real, signals::Split::held_out, InputNoise::as_measured)),
        fit(fit_hypothesis(fit_records, Hypothesis({&find_effect("delay")}))) {}
};

/// joint_error: error of the simulated joint share in its stated standard deviations, which limits
/// the accuracy of a stiffness estimate.
void add_trial(unsigned seed, double joint_error, Coverage& out) {
  const NominalModel right = test::nominal_of(test::OneModeRig{}, false);
  const Trial trial(right, seed);
  out.delay += trial.holds("delay", Trial::rig().delay_s);
  // The correct model closes the gap down to the noise.
  const ErrorScore score =
      score_held_out(trial.fit_records, trial.held_out, trial.fit, {.seed = seed}).overall;
  if (score.gap_closed_ci95)
    out.gap_closed += (*score.gap_closed_ci95)[0] <= 1. && 1. <= (*score.gap_closed_ci95)[1];
  NominalModel off = right;
  off.joint_share -= joint_error * off.joint_share_deviation;
  out.stiffness += Trial(off, seed).holds("stiffness", Trial::rig().stiffness);
}

/// |Z| is below it with probability p.
double half_normal_quantile(double p) {
  double low = 0., high = 10.;
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (std::erf(middle / std::sqrt(2.)) < p ? low : high) = middle;
  }
  return low;
}

TEST(LongIntervals, HoldTheTruthAsOftenAsTheySay) {
  constexpr unsigned n_trials = 200;
  // The share is at most 1, so the quantiles are those of a half-normal distribution.
  std::vector<double> joint_error;
  for (unsigned i = 0; i < n_trials; ++i)
    joint_error.push_back(half_normal_quantile((i + 0.5) / n_trials));
  std::shuffle(joint_error.begin(), joint_error.end(), std::mt19937(1));
  Coverage halves[2];
  std::thread other([&] {
    for (unsigned seed = 1; seed < n_trials; seed += 2)
      add_trial(seed, joint_error[seed], halves[1]);
  });
  for (unsigned seed = 0; seed < n_trials; seed += 2) add_trial(seed, joint_error[seed], halves[0]);
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
