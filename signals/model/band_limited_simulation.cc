#include "signals/model/band_limited_simulation.h"

#include <cstddef>
#include <span>
#include <vector>

#include "signals/spectra/resample.h"

namespace vibrissa::signals {

namespace {

constexpr std::size_t steps_per_sample = 16;
constexpr double flat_to_share = 0.995;

std::vector<double> every(const std::vector<double>& x, const std::size_t factor) {
  std::vector<double> kept;
  kept.reserve(x.size() / factor);
  for (std::size_t i = 0; i < x.size(); i += factor) kept.push_back(x[i]);
  return kept;
}

}  // namespace

ReducedOutput simulate_band_limited(const ReducedModel& model, const ReducedInput& input) {
  check(model, input);
  const double fine_rate_hz = steps_per_sample * input.sampling_rate_hz;
  const auto fine = [&](const std::span<const double> x) {
    return resample(x, input.sampling_rate_hz, fine_rate_hz, flat_to_share);
  };
  const auto base = fine(input.base_acceleration), cross = fine(input.cross_acceleration),
             wind = fine(input.wind_speed);
  const ReducedOutput output =
      simulate(model, {fine_rate_hz, steps_per_sample * input.n_samples, base, cross, wind});
  return {every(output.base_moment, steps_per_sample),
          every(output.cross_moment, steps_per_sample)};
}

}  // namespace vibrissa::signals
