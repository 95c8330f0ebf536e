#include "separation/identification/hold_check.h"

#include <gmock/gmock.h>

#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::Signal;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

using test::rate_hz;

// Records that truly ran so, with noise 40 dB below.
HoldDiagnosis diagnose(const Bvrm& truth, Hold ran, Hold told, bool direct_term,
                       std::uint64_t seed = 1) {
  const Signal input = test::white_noise(6000, 3., seed);
  const Signal clean = simulate(truth, input, rate_hz, ran);
  const Signal output = test::plus_noise(clean, 0.01 * test::rms(clean), 100 + seed);
  const Segment segment{input, output};
  return check_hold(truth, std::span(&segment, 1), rate_hz,
                    {.hold = told, .direct_term = direct_term});
}

constexpr std::array holds{Hold::zero_order, Hold::first_order, Hold::band_limited};

TEST(HoldCheck, NoticesEveryWrongHoldAndNamesTheRightOne) {
  for (const std::size_t n_modes : {1u, 2u})
    for (const bool direct_term : {true, false})
      for (const Hold ran : holds)
        for (const Hold told : holds) {
          const Bvrm truth = test::sensor(n_modes, direct_term ? -2e-7 : 0.);
          const HoldDiagnosis found = diagnose(truth, ran, told, direct_term);
          EXPECT_EQ(found.likely, ran)
              << n_modes << direct_term << " told " << to_string(told) << ": " << found.words;
          EXPECT_EQ(found.words.empty(), ran == told) << found.words;
          EXPECT_EQ(found.trials[0].hold, told);
        }
}

TEST(HoldCheck, IsSilentAboutTheRightHoldInHundredsOfRecords) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed)
    for (const Hold hold : {Hold::zero_order, Hold::first_order})
      EXPECT_THAT(diagnose(test::sensor(1, -2e-7), hold, hold, true, seed).words, IsEmpty());
}

// A moment with its viscous part leads by 2 zeta / w, as a mode may.
TEST(HoldCheck, IsSilentAboutTheViscousPartOfTheMoment) {
  Bvrm truth = test::sensor(1, -2e-7);
  ModalTerm& mode = truth.modes[0];
  mode.b1 = mode.b0 * 2. * mode.damping_ratio() / std::sqrt(mode.a0);
  EXPECT_THAT(diagnose(truth, Hold::first_order, Hold::first_order, true).words, IsEmpty());
  EXPECT_EQ(diagnose(truth, Hold::first_order, Hold::zero_order, true).likely, Hold::first_order);
  EXPECT_EQ(diagnose(truth, Hold::zero_order, Hold::first_order, true).likely, Hold::zero_order);
}

TEST(HoldCheck, LeavesOutHoldsUnderWhichAModeIsNotToldFromItsAlias) {
  Bvrm truth = test::sensor(1, -2e-7);
  truth.modes.push_back(make_modal_term(0.64 * rate_hz, 0.02, -1e-6));
  const HoldDiagnosis found = diagnose(truth, Hold::band_limited, Hold::band_limited, true);
  EXPECT_EQ(found.trials.size(), 1u);
  EXPECT_EQ(found.likely, Hold::band_limited);
  EXPECT_THAT(found.words, IsEmpty());
}

TEST(HoldCheck, SaysHowLargeTheDelayIsAndThatAShiftLooksTheSame) {
  EXPECT_THAT(diagnose(test::sensor(1, -2e-7), Hold::zero_order, Hold::first_order, true).words,
              AllOf(HasSubstr("the two channels are shifted by 1"), HasSubstr("lags behind"),
                    HasSubstr("with zero_order it does not")));
  EXPECT_THAT(diagnose(test::sensor(1), Hold::zero_order, Hold::first_order, false).words,
              HasSubstr("zero_order is the likely hold"));
}

}  // namespace
}  // namespace vibrissa::separation
