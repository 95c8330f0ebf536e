#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/search/search.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using ::testing::AllOf;
using ::testing::Gt;
using ::testing::Lt;

constexpr std::size_t n_samples = 2048;

/// Consecutive records with the same excitation. The silicone warms from the first record on and
/// softens exponentially: change (1 - exp(-n / settled_after)).
signals::Dataset warming_up(double change, double settled_after, unsigned n_records) {
  test::OneModeRig rig = test::noisy_rig();
  const double duration_s = static_cast<double>(n_samples) / rig.rate_hz;
  const std::vector<double> lines = test::scattered_lines_hz();
  signals::Dataset out;
  for (unsigned number = 0; number < n_records; ++number) {
    rig.warming = [=](double t_s) {
      const double n = number + std::max(0., t_s) / duration_s;
      return change * (1. - std::exp(-n / settled_after));
    };
    out.records.push_back({"record_" + std::to_string(number),
                           rig.record(n_samples, duration_s, test::sines(lines, 2., 5 + number),
                                      test::no_signal, 7 + 13 * number, false),
                           {true, false},
                           0,
                           signals::Split::fit,
                           rig.readout,
                           {}});
  }
  return out;
}

TEST(TemperatureDrift, ThatSettlesIsNamedWithTheRecordsItTakes) {
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, false), warming_up(-0.04, 2., 6),
                         signals::Split::fit, InputNoise::reduced);
  const SearchResult result = search(experiment, {.max_effects = 1});
  ASSERT_EQ(result.candidates.front().name, "temperature_drift");
  const HypothesisFit& fit = result.fits[result.candidates.front().fit];
  const auto settled = static_cast<Eigen::Index>(fit.index("temperature_drift", 3).value());
  EXPECT_THAT(std::exp(fit.x(settled)), AllOf(Gt(1.5), Lt(2.6)));
}

}  // namespace
}  // namespace vibrissa::diagnosis
