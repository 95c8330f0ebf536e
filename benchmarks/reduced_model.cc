#include "signals/model/reduced_model.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace {

using namespace vibrissa::signals;

ReducedModel six_modes() {
  ReducedModel model;
  for (const double f : {37.3, 37.3, 147., 528., 528., 654.}) {
    model.modes.push_back({f, 0.05, {0.02, 0.01, 0.}, {1e-4, 8e-4, 0.}});
  }
  model.rigid_moment[1][0] = 2.3e-5;
  return model;
}

void sixty_seconds_at_one_kilohertz(benchmark::State& state) {
  constexpr double rate_hz = 1000., duration_s = 60.;
  const ReducedModel model = six_modes();
  std::vector<double> a(static_cast<std::size_t>(rate_hz * duration_s));
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = std::sin(0.2 * static_cast<double>(i));
  for (auto _ : state) {
    benchmark::DoNotOptimize(simulate(model, {rate_hz, a.size(), a}));
  }
  state.counters["times_real_time"] = benchmark::Counter(
      duration_s * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["ns_per_sample_and_mode"] = benchmark::Counter(
      static_cast<double>(state.iterations() * a.size() * model.modes.size()) * 1e-9,
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(sixty_seconds_at_one_kilohertz)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
