#include "diagnosis/fit/goodness_of_fit.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// Whitened residuals of complex normal bins with a frequency-dependent power factor.
std::vector<WhitenedRecord> residuals(const Experiment& experiment, unsigned seed,
                                      const std::function<double(double hz)>& factor,
                                      double own_share = 0.5) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0., std::sqrt(0.5));
  std::vector<WhitenedRecord> out;
  for (const PreparedRecord& record : experiment.records) {
    WhitenedRecord& one = out.emplace_back();
    for (std::size_t b = 0; b < record.n_bins(); ++b) {
      const double scale = std::sqrt(factor(static_cast<double>(b + 1) * record.bin_hz()));
      one.error.push_back(scale * Complex(normal(random), normal(random)));
      one.deviation.push_back(1.);
      one.own_share.push_back(own_share);
    }
  }
  return out;
}

class GoodnessOfFitTest : public testing::Test {
 protected:
  Experiment experiment_ = prepare_experiment(test::nominal_of(test::OneModeRig{}, true),
                                              test::rig_dataset(test::noisy_rig(), {.wind = true}),
                                              signals::Split::fit, InputNoise::reduced);
};

TEST_F(GoodnessOfFitTest, FindsNothingInWhiteResiduals) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const GoodnessOfFit found =
        goodness_of_fit(experiment_, residuals(experiment_, seed, [](double) { return 1.; }));
    EXPECT_NEAR(found.excess, 0., 0.1);
    EXPECT_LT(found.misshape_nats, 40.);
  }
}

TEST_F(GoodnessOfFitTest, SeesPowerThatIsLeft) {
  const GoodnessOfFit found =
      goodness_of_fit(experiment_, residuals(experiment_, 1, [](double) { return 1.5; }));
  EXPECT_NEAR(found.excess, 0.5, 0.15);
}

TEST_F(GoodnessOfFitTest, SeesTheRightPowerWithTheWrongSpectrum) {
  const auto half = [](double hz) { return hz < 125. ? 1.9 : 0.1; };
  const GoodnessOfFit found = goodness_of_fit(experiment_, residuals(experiment_, 1, half));
  EXPECT_NEAR(found.excess, 0., 0.15);
  // Each bin with a factor f > 1 gains f - 1 - ln f, minus the cost of the block factors.
  double n_bins = 0.;
  for (const PreparedRecord& record : experiment_.records)
    n_bins += static_cast<double>(record.n_bins());
  const double all = 0.5 * n_bins * (0.9 - std::log(1.9));
  EXPECT_LT(found.misshape_nats, 1.1 * all);
  EXPECT_GT(found.misshape_nats, 0.3 * all);
  EXPECT_EQ(goodness_of_fit(experiment_, residuals(experiment_, 1, half, 0.05)).misshape_nats, 0.)
      << "no noise of an effect is there";
  EXPECT_NEAR(found.surplus_nats_per_bin * n_bins, found.misshape_nats, 1e-9 * n_bins);
}

TEST_F(GoodnessOfFitTest, SeesATone) {
  std::vector<WhitenedRecord> white = residuals(experiment_, 1, [](double) { return 1.; });
  EXPECT_LT(goodness_of_fit(experiment_, white).tone_nats, 10.);
  const auto with_a_tone_in = [&](std::size_t record, std::size_t bin) {
    std::vector<WhitenedRecord> loud = white;
    loud[record].error.at(bin) = Complex(0., 7.);
    return goodness_of_fit(experiment_, loud).tone_nats;
  };
  ASSERT_FALSE(experiment_.records[0].excitation.base || experiment_.records[0].excitation.wind);
  EXPECT_NEAR(with_a_tone_in(0, 100), 49. - std::log(white[0].error.size() - 8.), 1e-9);
  EXPECT_LT(with_a_tone_in(0, 3), 10.) << "what wanders";
  EXPECT_LT(with_a_tone_in(1, 100), 10.) << "the base moves";
}

}  // namespace
}  // namespace vibrissa::diagnosis
