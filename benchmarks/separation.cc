#include <benchmark/benchmark.h>
#include <fftw3.h>
#include <speex/speex_echo.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "separation/filters/bvrm_separator.h"
#include "separation/filters/fdaf.h"
#include "separation/filters/kalman_filter.h"
#include "separation/metrics/dtw.h"

namespace {

using namespace vibrissa::separation;

std::vector<double> noise(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> x(n);
  for (double& value : x) value = normal(random);
  return x;
}

/// The shortest time so far of something that is timed again and again [s]: what it takes when
/// nothing else runs.
class Stopwatch {
 public:
  void time(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    shortest_s_ = std::min(shortest_s_, taken.count());
  }
  double shortest_s() const { return shortest_s_; }

 private:
  double shortest_s_ = std::numeric_limits<double>::infinity();
};

/// A pair of real transforms there and back. Planner: FFTW_PATIENT finds the quickest plan, another
/// one in each run; FFTW_ESTIMATE, which signals::RealFft takes, always the same.
class TransformPair {
 public:
  TransformPair(int n, unsigned planner)
      : time_(fftw_alloc_real(static_cast<std::size_t>(n))),
        spectrum_(fftw_alloc_complex(static_cast<std::size_t>(n / 2 + 1))),
        forward_(fftw_plan_dft_r2c_1d(n, time_, spectrum_, planner)),
        inverse_(fftw_plan_dft_c2r_1d(n, spectrum_, time_, planner)) {
    std::fill_n(time_, n, 0.);
  }
  ~TransformPair() {
    fftw_destroy_plan(forward_);
    fftw_destroy_plan(inverse_);
    fftw_free(time_);
    fftw_free(spectrum_);
  }
  TransformPair(const TransformPair&) = delete;
  TransformPair& operator=(const TransformPair&) = delete;
  void run() const {
    fftw_execute(forward_);
    fftw_execute(inverse_);
  }

 private:
  double* time_;
  fftw_complex* spectrum_;
  fftw_plan forward_, inverse_;
};

/// SpeexDSP's echo canceller alone, without its residual suppressor.
class Speex {
 public:
  Speex(int block, int n_taps)
      : block_(block),
        state_(speex_echo_state_init(block, n_taps)),
        out_(static_cast<std::size_t>(block)) {
    for (const double value : noise(n_block * static_cast<std::size_t>(block), 3))
      far_.push_back(static_cast<spx_int16_t>(3000. * value));
    near_ = far_;
    std::ranges::rotate(near_, near_.end() - 5);
  }
  ~Speex() { speex_echo_state_destroy(state_); }
  Speex(const Speex&) = delete;
  Speex& operator=(const Speex&) = delete;
  void run() {
    for (std::size_t b = 0; b < n_block; ++b) {
      const std::size_t first = b * static_cast<std::size_t>(block_);
      speex_echo_cancellation(state_, near_.data() + first, far_.data() + first, out_.data());
    }
  }
  static constexpr std::size_t n_block = 100;

 private:
  int block_;
  SpeexEchoState* state_;
  std::vector<spx_int16_t> far_, near_, out_;
};

// Ours, the transforms that it cannot do without, and SpeexDSP, by turns, so that a disturbance of
// the machine meets all three.
template <typename Filter>
void compare(benchmark::State& state, Filter& filter, std::size_t n_partitions) {
  const auto n_taps = static_cast<int>(state.range(0)), block = static_cast<int>(state.range(1));
  const auto n_samples = Speex::n_block * static_cast<std::size_t>(block);
  const auto x = noise(n_samples, 1), d = noise(n_samples, 2);
  std::vector<double> wind(n_samples);
  Speex speex(block, n_taps);
  const TransformPair quickest(2 * block, FFTW_PATIENT), same(2 * block, FFTW_ESTIMATE);
  // Input, output, error, and two for each partition's constraint.
  const double n_transforms = 3. + 2. * static_cast<double>(n_partitions);
  Stopwatch ours, transforms, same_transforms, peer;
  for (auto _ : state) {
    ours.time([&] { filter.process(x, d, wind); });
    transforms.time([&] {
      for (std::size_t i = 0; i < Speex::n_block; ++i) quickest.run();
    });
    same_transforms.time([&] {
      for (std::size_t i = 0; i < Speex::n_block; ++i) same.run();
    });
    peer.time([&] { speex.run(); });
    benchmark::DoNotOptimize(wind.data());
  }
  const double bound_s = transforms.shortest_s() * n_transforms / 2.;
  state.counters["Msamples_per_s"] = 1e-6 * static_cast<double>(n_samples) / ours.shortest_s();
  state.counters["bound"] = 1e-6 * static_cast<double>(n_samples) / bound_s;
  state.counters["speex"] = 1e-6 * static_cast<double>(n_samples) / peer.shortest_s();
  state.counters["of_bound"] = bound_s / ours.shortest_s();
  state.counters["of_bound_same_plans"] =
      same_transforms.shortest_s() * n_transforms / 2. / ours.shortest_s();
  state.counters["over_speex"] = peer.shortest_s() / ours.shortest_s();
}

void fdaf(benchmark::State& state) {
  FdafOptions options;
  options.filter_length = static_cast<std::size_t>(state.range(0));
  options.block_length = static_cast<std::size_t>(state.range(1));
  Fdaf filter(options);
  compare(state, filter, filter.n_partitions());
}

void kalman(benchmark::State& state) {
  KalmanOptions options;
  options.filter_length = static_cast<std::size_t>(state.range(0));
  options.block_length = static_cast<std::size_t>(state.range(1));
  PartitionedKalman filter(options);
  compare(state, filter, filter.n_taps() / options.block_length);
}

void real_time_bvrm_three_modes(benchmark::State& state) {
  Bvrm model;
  model.modes = {make_modal_term(31.47, 0.027, -9e-6), make_modal_term(95., 0.04, -5e-7),
                 make_modal_term(172., 0.02, -8e-7)};
  BvrmSeparator separator(model, 500.);
  const std::size_t n_samples = 30000, n_call = static_cast<std::size_t>(state.range(0));
  const auto x = noise(n_samples, 1), d = noise(n_samples, 2);
  std::vector<double> wind(n_samples);
  Stopwatch ours;
  for (auto _ : state) {
    ours.time([&] {
      for (std::size_t i = 0; i + n_call <= n_samples; i += n_call)
        separator.process(std::span(x).subspan(i, n_call), std::span(d).subspan(i, n_call),
                          std::span(wind).subspan(i, n_call));
    });
    benchmark::DoNotOptimize(wind.data());
  }
  state.counters["ns_per_sample"] = 1e9 * ours.shortest_s() / static_cast<double>(n_samples);
}

void time_warping(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  const auto x = noise(n, 1), y = noise(n, 2);
  const bool with_length = state.range(1) != 0;
  Stopwatch ours;
  for (auto _ : state)
    ours.time([&] { benchmark::DoNotOptimize(with_length ? dtw(x, y).cost : dtw_cost(x, y)); });
  state.counters["Mcells_per_s"] = 1e-6 * static_cast<double>(n * n) / ours.shortest_s();
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"taps", "block"})->Unit(benchmark::kMillisecond);
  for (const int taps : {400, 1600})
    for (const int block : {20, 64, 200}) benchmark->Args({taps, block});
}
BENCHMARK(fdaf)->Apply(sizes);
BENCHMARK(kalman)->Apply(sizes);
BENCHMARK(real_time_bvrm_three_modes)
    ->ArgName("samples_a_call")
    ->Arg(1)
    ->Arg(20)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(time_warping)
    ->ArgNames({"samples", "path_length"})
    ->Args({10000, 0})
    ->Args({10000, 1})
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
