// Time per sample to predict the records of an experiment by the measuring chain: linear, and with
// a nonlinear joint, and the spectra for a likelihood over lines.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <random>

#include "diagnosis/prediction/chain_simulation.h"

namespace {

using namespace vibrissa;
using namespace vibrissa::diagnosis;

constexpr std::size_t n_samples = 4096, n_records = 6;

NominalModel two_modes() {
  NominalModel model;
  model.modes = {{.frequency_rad_s = 2. * std::numbers::pi * 37.3,
                  .damping_ratio = 0.05,
                  .base_gain = -8.4e-6,
                  .base_rate = -7.9e-7},
                 {.frequency_rad_s = 2. * std::numbers::pi * 230.,
                  .damping_ratio = 0.05,
                  .base_gain = -1.7e-7,
                  .base_rate = -1.6e-8}};
  model.has_base = true;
  return model;
}

Experiment experiment() {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  signals::Dataset dataset;
  for (std::size_t r = 0; r < n_records; ++r) {
    std::vector<double> acceleration(n_samples), moment(n_samples);
    for (double& a : acceleration) a = 3. * normal(random);
    for (double& m : moment) m = 1e-5 * normal(random);
    signals::Record record(500., n_samples);
    record.set_channel(signals::channel::base_acceleration, acceleration);
    record.set_channel(signals::channel::base_moment, moment);
    dataset.records.push_back({"record" + std::to_string(r),
                               std::move(record),
                               {true, false},
                               n_samples,
                               signals::Split::fit,
                               signals::Readout::moment});
  }
  return prepare_experiment(two_modes(), dataset, signals::Split::fit, InputNoise::as_measured);
}

void predict(benchmark::State& state, const char* effect) {
  const Experiment prepared = experiment();
  Chain chain{.structure = prepared.nominal, .joint_share = 0.7};
  if (*effect != 0)
    find_effect(effect).extend(chain, find_effect(effect).starts.front(), prepared.scales);
  for (auto _ : state) benchmark::DoNotOptimize(ChainSimulator(chain).means(prepared.records));
  state.counters["time_per_sample"] = benchmark::Counter(
      static_cast<double>(n_samples * n_records),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

BENCHMARK_CAPTURE(predict, linear, "")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(predict, viscoelastic, "viscoelastic")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(predict, cubic, "hardening")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(predict, friction, "joint_friction")->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
