#include "diagnosis/fit/predicted_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "diagnosis/records/evaluated_samples.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

struct Leftover {
  double of_the_wind = 0.;         // amplitude of its lines, of the noise's
  double own_share = 0.5;          // in records with wind
  double own_share_windless = 0.;  // in the others
  unsigned seed = 1;
};

class PredictedNoiseTest : public testing::Test {
 protected:
  Experiment experiment_ = prepare_experiment(test::nominal_of(test::OneModeRig{}, true),
                                              test::rig_dataset(test::noisy_rig(), {.wind = true}),
                                              signals::Split::fit, InputNoise::reduced);

  /// White noise and the lines of the wind speed with independent phases.
  std::vector<WhitenedRecord> residuals(const Leftover& leftover) const {
    std::mt19937 random(leftover.seed);
    std::normal_distribution<double> normal(0., std::sqrt(0.5));
    std::vector<WhitenedRecord> out;
    for (const PreparedRecord& record : experiment_.records) {
      const bool windy = record.excitation.wind;
      const std::vector<Complex> wind =
          windy ? evaluated_bins(record, record.wind) : std::vector<Complex>(record.n_bins());
      double power = 0.;
      for (const Complex line : wind) power += std::norm(line);
      const double height = windy ? std::sqrt(static_cast<double>(record.n_bins()) / power) : 0.;
      const Complex gain = std::polar(leftover.of_the_wind * height, 1.);
      WhitenedRecord& one = out.emplace_back();
      for (std::size_t b = 0; b < record.n_bins(); ++b) {
        one.error.push_back(gain * wind[b] + Complex(normal(random), normal(random)));
        one.deviation.push_back(1.);
        one.own_share.push_back(windy ? leftover.own_share : leftover.own_share_windless);
      }
    }
    return out;
  }

  PredictedNoise found(const Leftover& leftover) const {
    return predicted_noise(experiment_, residuals(leftover));
  }
};

TEST_F(PredictedNoiseTest, FindsNothingInNoise) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const PredictedNoise noise = found({.seed = seed});
    EXPECT_LT(std::abs(noise.nats), 40.);
    EXPECT_LT(noise.share, 0.05);
  }
}

TEST_F(PredictedNoiseTest, FindsWhatFollowsTheWind) {
  const PredictedNoise noise = found({.of_the_wind = 1.});
  EXPECT_GT(noise.nats, 200.);
  // Half of the energy; the lines of the gusts are in few blocks.
  EXPECT_GT(noise.share, 0.3);
  EXPECT_LT(noise.share, 0.7);
}

TEST_F(PredictedNoiseTest, LooksOnlyWhereEffectsOfTheWindCallItNoise) {
  EXPECT_EQ(found({.of_the_wind = 1., .own_share = 0.05}).nats, 0.) << "the sensor's noise";
  EXPECT_EQ(found({.of_the_wind = 1., .own_share_windless = 0.5}).nats, 0.)
      << "noise that needs no wind";
}

}  // namespace
}  // namespace vibrissa::diagnosis
