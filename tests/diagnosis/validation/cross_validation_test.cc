#include "diagnosis/validation/cross_validation.h"

#include <gmock/gmock.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using signals::Split;

/// A fit of one rig's records, and its residual in another rig's held-out record.
ResidualExcess left_of(const test::OneModeRig& held_out_rig, const test::OneModeRig& rig,
                       const std::vector<const Effect*>& effects) {
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  const Experiment fit_records =
      prepare_experiment(nominal, test::rig_dataset(rig), Split::fit, InputNoise::reduced);
  const Experiment held_out = prepare_experiment(nominal, test::rig_dataset(held_out_rig),
                                                 Split::held_out, InputNoise::as_measured);
  return residual_excess(fit_records, held_out, fit_hypothesis(fit_records, Hypothesis(effects)));
}

TEST(ResidualExcess, IsChanceWhereTheCauseIsRight) {
  test::OneModeRig rig = test::noisy_rig();
  EXPECT_LT(std::abs(left_of(rig, rig, {}).n_deviations), 4.);
  rig.delay_s = 1e-3;
  const ResidualExcess left = left_of(rig, rig, {&find_effect("delay")});
  EXPECT_LT(left.n_deviations, 4.);
  EXPECT_FALSE(contradicted_by(left));
}

TEST(ResidualExcess, ContradictsACauseThatDoesNotCarryOver) {
  test::OneModeRig rig = test::noisy_rig(), other = rig;
  rig.delay_s = 1e-3;
  other.delay_s = 3e-3;
  const ResidualExcess left = left_of(other, rig, {&find_effect("delay")});
  EXPECT_EQ(left.record, "held_out");
  EXPECT_TRUE(contradicted_by(left));
}

TEST(ResidualExcess, ContradictsNothingThatIsTooLittleOrMayBeChance) {
  EXPECT_FALSE(contradicted_by({.excess = 0.1, .n_deviations = 50.}));
  EXPECT_FALSE(contradicted_by({.excess = 2., .n_deviations = 2.}));
  EXPECT_TRUE(contradicted_by({.excess = 2., .n_deviations = 50., .share_of_gap = 0.3}));
  EXPECT_FALSE(contradicted_by({.excess = 2., .n_deviations = 50., .share_of_gap = 0.02}));
}

/// Two known answers with separate fits, and outside_catalogue.
SearchResult result_of(const Experiment& experiment, double behind_nats) {
  SearchResult result;
  result.fits.push_back(fit_hypothesis(experiment, Hypothesis{}));
  result.fits.push_back(fit_hypothesis(experiment, Hypothesis({&find_effect("delay")})));
  result.fits.push_back(fit_hypothesis(experiment, Hypothesis::discrepancy()));
  result.candidates = {
      {.name = "none", .fit = 0, .calibrations = {}, .log_posterior = 0.},
      {.name = "delay", .fit = 1, .calibrations = {}, .log_posterior = -behind_nats},
      {.name = "outside_catalogue", .fit = 2, .calibrations = {}, .log_posterior = -90.}};
  set_probabilities(result);
  return result;
}

std::vector<std::string> names(const std::vector<Candidate>& candidates) {
  std::vector<std::string> out;
  for (const Candidate& candidate : candidates) out.push_back(candidate.name);
  return out;
}

TEST(RefuteContradicted, LeavesTheNextAnswerOnlyWhereItIsNearlyAsProbable) {
  test::OneModeRig rig = test::noisy_rig();
  rig.delay_s = 1e-3;
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  const signals::Dataset dataset = test::rig_dataset(rig);
  const Experiment experiment =
      prepare_experiment(nominal, dataset, Split::fit, InputNoise::reduced);
  const Experiment held_out =
      prepare_experiment(nominal, dataset, Split::held_out, InputNoise::as_measured);
  SearchResult near = result_of(experiment, 1.), far = result_of(experiment, 10.);
  refute_contradicted(near, experiment, held_out);
  EXPECT_THAT(names(near.candidates), testing::ElementsAre("delay", "outside_catalogue"));
  EXPECT_THAT(names(near.refuted), testing::ElementsAre("none"));
  EXPECT_GT(near.candidates.front().probability, 0.99);
  refute_contradicted(far, experiment, held_out);
  EXPECT_THAT(names(far.candidates), testing::ElementsAre("outside_catalogue"));
  EXPECT_THAT(names(far.refuted), testing::ElementsAre("none", "delay"));
  EXPECT_EQ(far.candidates.front().probability, 1.);
}

}  // namespace
}  // namespace vibrissa::diagnosis
