#include "diagnosis/input_following.h"

#include <gtest/gtest.h>

#include <vector>

#include "diagnosis/search.h"
#include "one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

namespace channel = signals::channel;

Experiment experiment_of(const signals::Dataset& dataset) {
  return prepare_experiment(test::nominal_of(test::OneModeRig{}, true), dataset,
                            signals::Split::fit, InputNoise::reduced);
}

/// The sensor as simulated, whose reading picks up the wind's speed or the base's acceleration
/// itself, in proportion: no effect of the catalogue does.
signals::Dataset picking_up(const std::string& input, double gain, unsigned seed) {
  signals::Dataset out = test::rig_dataset(test::noisy_rig(), {.wind = true, .seed = seed});
  for (signals::DatasetRecord& entry : out.records) {
    const auto x = entry.record.channel(input), m = entry.record.channel(channel::base_moment);
    std::vector<double> read(m.begin(), m.end());
    double last = x.front();
    for (std::size_t k = 0; k < read.size(); ++k) {
      read[k] += gain * (x[k] - last) * entry.record.sampling_rate_hz();
      last = x[k];
    }
    entry.record.set_channel(channel::base_moment, std::move(read));
  }
  return out;
}

TEST(InputFollowing, IsNoMoreThanChanceWhereNothingIsMissed) {
  double sum = 0.;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Experiment experiment = experiment_of(picking_up(channel::wind_speed, 0., seed));
    const double following = input_following(experiment, fit_hypothesis(experiment, Hypothesis{}));
    EXPECT_LT(following, 3.) << seed;
    sum += following;
  }
  EXPECT_LT(sum / 12., 1.);
}

TEST(InputFollowing, IsLargeWhereAnInputIsMissed) {
  for (const auto& [input, gain] :
       {std::pair{channel::wind_speed, 3e-7}, {channel::base_acceleration, 1e-9}}) {
    const Experiment experiment = experiment_of(picking_up(input, gain, 1));
    EXPECT_GT(input_following(experiment, fit_hypothesis(experiment, Hypothesis{})), 5.) << input;
  }
}

TEST(InputFollowing, RefusesTheAnswersThatItContradicts) {
  const SearchResult result =
      search(experiment_of(picking_up(channel::wind_speed, 3e-7, 1)), {.max_effects = 2});
  EXPECT_EQ(result.candidates.front().name, outside_catalogue);
  EXPECT_FALSE(result.refuted.empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
