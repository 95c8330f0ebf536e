// Identification of the sensor of the reference study (31.47 Hz, damping ratio 0.027, with a second
// mode at 172 Hz) from white base acceleration at 500 Hz, noise 40 dB below the moment. What is
// timed: "refine" is the time-domain fit alone, from the start that the frequency fit gave (gains,
// poles, initial states, offset, and the covariance at the end); "start" is what leads there
// (Welch's response and its fit); "whole" is both.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "separation/identification/identify_frequency.h"
#include "separation/identification/output_error.h"
#include "separation/identification/srivc.h"
#include "separation/model/simulation.h"

namespace {

using namespace vibrissa::separation;

constexpr double rate_hz = 500.;

struct Experiment {
  std::vector<double> acceleration, moment;
  std::size_t order;
  Segment segment() const { return {acceleration, moment}; }
};

Experiment experiment(std::size_t n_modes, std::size_t n_samples) {
  Bvrm truth{.modes = {make_modal_term(31.47, 0.027, -9e-6, -2e-9)}, .direct_term_kg_m = -2e-7};
  if (n_modes == 2) truth.modes.push_back(make_modal_term(172., 0.02, -8e-7, 3e-10));
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Experiment result{
      .acceleration = std::vector<double>(n_samples), .moment = {}, .order = 2 * n_modes};
  for (double& a : result.acceleration) a = 3. * normal(random);
  result.moment = simulate(truth, result.acceleration, rate_hz);
  double power = 0.;
  for (const double m : result.moment) power += m * m / static_cast<double>(n_samples);
  for (double& m : result.moment) m += 0.01 * std::sqrt(power) * normal(random);
  return result;
}

FittedBvrm start_of(const Experiment& data) {
  const auto response = vibrissa::signals::welch_response(
      data.acceleration, data.moment, rate_hz,
      {.segment_samples = data.moment.size() < 10000 ? 1024u : 2048u});
  return identify_frequency(
      response, {.order = data.order, .sampling = Sampling{rate_hz, Hold::first_order}});
}

FittedBvrm refine(const Experiment& data, const Bvrm& start) {
  const Segment segment = data.segment();
  return refine_output_error(start, std::span(&segment, 1), rate_hz);
}

FittedBvrm srivc(const Experiment& data, const Bvrm& start) {
  const Segment segment = data.segment();
  return refine_srivc(start, std::span(&segment, 1), rate_hz);
}

void count(benchmark::State& state, const FittedBvrm& fit, std::size_t n_samples) {
  state.counters["ns_per_sample"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(n_samples) * 1e-9,
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["evaluations"] = fit.n_iterations;
  state.counters["frequency_hz"] = fit.modes[0].frequency_hz.value;
  state.counters["sd_hz"] = fit.modes[0].frequency_hz.standard_deviation;
}

void start(benchmark::State& state, std::size_t n_modes, std::size_t n_samples) {
  const Experiment data = experiment(n_modes, n_samples);
  FittedBvrm fit;
  for (auto _ : state) benchmark::DoNotOptimize(fit = start_of(data));
  count(state, fit, n_samples);
}

template <auto method>
void refined_by(benchmark::State& state, std::size_t n_modes, std::size_t n_samples) {
  const Experiment data = experiment(n_modes, n_samples);
  const Bvrm start = start_of(data).model;
  FittedBvrm fit;
  for (auto _ : state) benchmark::DoNotOptimize(fit = method(data, start));
  count(state, fit, n_samples);
}

constexpr auto output_error_refine = refined_by<refine>;
constexpr auto srivc_refine = refined_by<srivc>;

void output_error_whole(benchmark::State& state, std::size_t n_modes, std::size_t n_samples) {
  const Experiment data = experiment(n_modes, n_samples);
  FittedBvrm fit;
  for (auto _ : state) benchmark::DoNotOptimize(fit = refine(data, start_of(data).model));
  count(state, fit, n_samples);
}

#define VIBRISSA_IDENTIFICATION(name)                                                     \
  BENCHMARK_CAPTURE(name, one_mode_5000_samples, 1, 5000)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(name, two_modes_30000_samples, 2, 30000)->Unit(benchmark::kMillisecond)
VIBRISSA_IDENTIFICATION(output_error_refine);
VIBRISSA_IDENTIFICATION(srivc_refine);
VIBRISSA_IDENTIFICATION(start);
VIBRISSA_IDENTIFICATION(output_error_whole);

}  // namespace

BENCHMARK_MAIN();
