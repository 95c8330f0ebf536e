#include "trial/generator/simulation_form.h"

#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include "signals/spectra/fft.h"
#include "trial/generator/trial_case.h"
#include "trial/generator/unexplained_change.h"

namespace vibrissa::trial {
namespace {

/// Response of periodic records at the excited lines.
std::vector<std::complex<double>> response_of(const signals::Dataset& records) {
  std::vector<std::complex<double>> out;
  for (const signals::DatasetRecord& entry : records.records) {
    if (entry.period_samples == 0) continue;
    const auto lines = [&](const std::string& channel) {
      const auto all = entry.record.channel(channel);
      return signals::real_fft(
          std::vector<double>(all.begin(), all.begin() + static_cast<long>(entry.period_samples)));
    };
    const auto a = lines(signals::channel::base_acceleration),
               m = lines(signals::channel::base_moment);
    double largest = 0.;
    for (const auto& line : a) largest = std::max(largest, std::abs(line));
    for (std::size_t k = 0; k < a.size(); ++k)
      if (std::abs(a[k]) > 0.5 * largest) out.push_back(m[k] / a[k]);
  }
  return out;
}

TEST(SimulationForm, HasTheErrorThatItStates) {
  const Structure& sensor = structure_of({});
  for (const double error : {0., 0.01, 0.03})
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      const SimulationForm form = draw_form(sensor, error, seed);
      EXPECT_NEAR(form_error(sensor, form.structure), error, 1e-3 * error) << seed;
    }
}

TEST(SimulationForm, OfTheRecordsHasTheErrorThatItStates) {
  // From the written records: what a stranger measures who has both simulations.
  const std::vector<std::complex<double>> exact = response_of(simulated_records(4));
  int n_tested = 0;
  for (std::uint64_t seed = 1; seed <= 12 && n_tested < 3; ++seed) {
    const SimulationForm form = draw_form(structure_of({}), 0.03, seed);
    if (form.hold != Hold::band_limited) continue;
    ++n_tested;
    const std::vector<std::complex<double>> off =
        response_of(simulated_records(4, form, RecordSet::complete));
    ASSERT_EQ(off.size(), exact.size());
    double difference = 0., power = 0.;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      difference += std::norm(off[i] - exact[i]);
      power += std::norm(exact[i]);
    }
    EXPECT_NEAR(std::sqrt(difference / power), 0.03, 0.003) << seed;
  }
  EXPECT_EQ(n_tested, 3);
}

TEST(SimulationForm, DrawsHoldsAndFewerModes) {
  std::set<Hold> holds;
  std::set<long> modes;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const SimulationForm form = draw_form(structure_of({}), 0.03, seed);
    holds.insert(form.hold);
    modes.insert(form.structure.frequency_rad_s.size());
  }
  EXPECT_EQ(holds.size(), 3u);
  EXPECT_GE(modes.size(), 3u);
}

}  // namespace
}  // namespace vibrissa::trial
