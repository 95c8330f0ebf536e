
#include <gmock/gmock.h>

#include <cmath>
#include <optional>

#include "diagnosis/validation/held_out.h"
#include "diagnosis/validation/named_answers.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

class NamedAnswers : public testing::Test {
 protected:
  void measure(const test::OneModeRig& rig) {
    const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
    const signals::Dataset dataset = test::rig_dataset(rig);
    fit_records_ = prepare_experiment(nominal, dataset, signals::Split::fit, InputNoise::reduced);
    fit_as_measured_ =
        prepare_experiment(nominal, dataset, signals::Split::fit, InputNoise::as_measured);
    held_out_ =
        prepare_experiment(nominal, dataset, signals::Split::held_out, InputNoise::as_measured);
  }
  /// Answers in this order, the first with most of the probability.
  std::vector<Candidate> named(const std::vector<Hypothesis>& hypotheses) {
    SearchResult result;
    double probability = 0.9;
    for (const Hypothesis& hypothesis : hypotheses) {
      result.candidates.push_back({.name = hypothesis.name(),
                                   .fit = result.fits.size(),
                                   .calibrations = {},
                                   .probability = probability});
      result.fits.push_back(fit_hypothesis(fit_records_, hypothesis));
      probability *= 0.1;
    }
    name_answers(result, fit_records_, fit_as_measured_, held_out_);
    return result.candidates;
  }
  static Hypothesis of(const std::vector<std::string>& ids) {
    std::vector<const Effect*> effects;
    for (const std::string& id : ids) effects.push_back(&find_effect(id));
    return Hypothesis(effects);
  }

  /// What the answer "hardening" leaves of the gap of a stiffening spring that is not symmetric.
  std::optional<UnknownCause> left_by_hardening(const double cubic) {
    test::OneModeRig rig = test::noisy_rig();
    rig.cubic = cubic;
    rig.further = [](double x, double) { return 0.3 * x * x / 8e-4; };
    measure(rig);
    SearchResult result;
    for (const Hypothesis& hypothesis : {of({"hardening"}), of({})}) {
      result.candidates.push_back(
          {.name = hypothesis.name(), .fit = result.fits.size(), .calibrations = {}});
      result.fits.push_back(fit_hypothesis(fit_records_, hypothesis));
    }
    const ErrorScore left = score_held_out(fit_records_, held_out_, result.fits.front()).overall;
    share_left_ = 1. - left.gap_closed.value();
    power_left_ = std::pow(left.nrmse_after, 2) - std::pow(left.noise_floor, 2);
    return unknown_part(result, fit_records_, held_out_, 2);
  }

  Experiment fit_records_, fit_as_measured_, held_out_;
  double share_left_ = 0., power_left_ = 0.;
};

TEST_F(NamedAnswers, AreReducedToTheSimplestThatClosesTheGap) {
  test::OneModeRig rig = test::noisy_rig();
  rig.cubic = 1e7;
  measure(rig);
  const auto answers = named(
      {of({"coil_feedthrough", "hardening"}), of({"hardening"}), of({}), of({"coil_feedthrough"})});
  EXPECT_EQ(answers.front().name, "hardening");
  EXPECT_NEAR(answers.front().probability, 0.99, 1e-9);
}

TEST_F(NamedAnswers, KeepTwoEffectsThatBothAreNeeded) {
  test::OneModeRig rig = test::noisy_rig();
  rig.cubic = 2e6;
  rig.delay_s = 2e-3;
  measure(rig);
  SearchResult result = search(fit_records_);
  name_answers(result, fit_records_, fit_as_measured_, held_out_);
  EXPECT_EQ(result.candidates.front().name, "delay+hardening");
}

TEST_F(NamedAnswers, HoldTheCalibrationsThatMoved) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.8;
  measure(rig);
  EXPECT_EQ(named({of({})}).front().name, "stiffness");
}

TEST_F(NamedAnswers, LeaveOutAnEffectWithoutWhichUnseenRecordsArePredictedBetter) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.8;
  measure(rig);
  SearchResult result;
  for (const Hypothesis& hypothesis : {of({"softening_history"}), of({})}) {
    result.candidates.push_back({.name = hypothesis.name(),
                                 .fit = result.fits.size(),
                                 .calibrations = {},
                                 .probability = result.fits.empty() ? 0.99 : 0.01});
    result.fits.push_back(fit_hypothesis(fit_records_, hypothesis));
  }
  HypothesisFit& softened = result.fits.front();
  const auto set = [&](const std::string& id, const std::string& name, const double value) {
    for (std::size_t i = 0; i < softened.fit_parameters.size(); ++i) {
      const FitParameter& parameter = softened.fit_parameters[i];
      if (parameter.effect == &find_effect(id) && parameter.description.name == name)
        softened.x(static_cast<Eigen::Index>(i)) = std::log(value);
    }
  };
  set("softening_history", "softening", 0.08);
  set("softening_history", "level", 0.02);
  set("stiffness", "ratio", 0.84);
  name_answers(result, fit_records_, fit_as_measured_, held_out_);
  EXPECT_EQ(result.candidates.front().name, "stiffness");
}

TEST_F(NamedAnswers, KnowNoUnknownCauseWhereRecalibrationLeavesNothing) {
  measure(test::noisy_rig());
  EXPECT_EQ(named({Hypothesis::discrepancy(), of({})}).front().name, "none");
}

TEST_F(NamedAnswers, DescribeWhatTheyLeaveOfAGap) {
  EXPECT_TRUE(left_by_hardening(1e6));
  EXPECT_GT(share_left_, least_share);
}

TEST_F(NamedAnswers, DoNotDescribeASmallShareOfAGap) {
  EXPECT_FALSE(left_by_hardening(1e7));
  EXPECT_LT(share_left_, least_share);
  EXPECT_GT(power_left_, power_without_cause(fit_records_.simulation_accuracy));
}

}  // namespace
}  // namespace vibrissa::diagnosis
