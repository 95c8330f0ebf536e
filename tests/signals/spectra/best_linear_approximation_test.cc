#include "signals/spectra/best_linear_approximation.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "signals/base/error.h"
#include "signals/excitation/excitation.h"
#include "signals/spectra/fft.h"
#include "tests/signals/rate.h"

namespace vibrissa::signals {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;
using Complex = std::complex<double>;

using test::rate_hz;
constexpr std::size_t period_length = 1024;

Complex true_resonance(double frequency_hz) {
  const double ratio = frequency_hz / 31.47;
  return 1. / Complex(1. - ratio * ratio, 2. * 0.1 * ratio);
}

/// Steady state of one period of a Wiener system: a resonance, then x + squared x^2 + cubed x^3.
struct WienerSystem {
  double squared = 0., cubed = 0.;
  bool resonant = true;

  std::vector<double> operator()(const std::vector<double>& u) const {
    RealFft fft(u.size());
    std::ranges::copy(u, fft.time().begin());
    fft.forward();
    for (std::size_t k = 0; resonant && k < fft.n_bins(); ++k)
      fft.spectrum()[k] *=
          true_resonance(static_cast<double>(k) * rate_hz / static_cast<double>(u.size()));
    fft.inverse();
    std::vector<double> y(fft.time().begin(), fft.time().end());
    for (double& x : y) x += squared * x * x + cubed * x * x * x;
    return y;
  }
};

struct Measurement {
  std::vector<double> input, output;
  PeriodAverage average() const { return average_periods(input, output, rate_hz, period_length); }
};

/// Periods of both channels, each with white noise of its own.
Measurement measure(const std::vector<double>& drive, const WienerSystem& system,
                    std::size_t n_periods, double input_noise, double output_noise,
                    std::mt19937_64& random) {
  const auto response = system(drive);
  std::normal_distribution<double> normal;
  Measurement result;
  for (std::size_t i = 0; i < n_periods * drive.size(); ++i) {
    result.input.push_back(drive[i % drive.size()] + input_noise * normal(random));
    result.output.push_back(response[i % drive.size()] + output_noise * normal(random));
  }
  return result;
}

// The third harmonic of 60 Hz stays below half the rate: no aliases.
DesignedExcitation drives(LineGrid grid, std::size_t n_realisations, std::uint64_t seed) {
  return design_excitation({.high_hz = 60.,
                            .sampling_rate_hz = rate_hz,
                            .period_samples = period_length,
                            .grid = grid,
                            .phase = PhaseRule::random,
                            .n_realisations = n_realisations,
                            .seed = seed});
}

std::vector<PeriodAverage> averages(const DesignedExcitation& excitation,
                                    const WienerSystem& system, std::size_t n_periods,
                                    double input_noise, double output_noise,
                                    std::mt19937_64& random) {
  std::vector<PeriodAverage> result;
  for (const Drive& drive : excitation.drives)
    result.push_back(
        measure(drive.period, system, n_periods, input_noise, output_noise, random).average());
  return result;
}

// Mean over realisations and lines of the variance of one realisation's response without noise,
// from many of them: what the distortion is, without either method.
struct Ensemble {
  std::vector<Complex> mean;
  double variance = 0.;
};
Ensemble true_ensemble(const WienerSystem& system, LineGrid grid) {
  std::mt19937_64 random(1);
  constexpr std::size_t n = 1000;
  const auto all = averages(drives(grid, n, 77), system, 1, 0., 0., random);
  Ensemble ensemble;
  const auto lines = excited_orders(all.front());
  for (const std::size_t line : lines) {
    Complex mean = 0.;
    for (const auto& one : all) mean += one.response(line) / static_cast<double>(n);
    double scatter = 0.;
    for (const auto& one : all) scatter += std::norm(one.response(line) - mean);
    ensemble.mean.push_back(mean);
    ensemble.variance += scatter / static_cast<double>((n - 1) * lines.size());
  }
  return ensemble;
}

double mean_of(const std::vector<double>& x) {
  double sum = 0.;
  for (const double value : x) sum += value;
  return sum / static_cast<double>(x.size());
}

TEST(RobustApproximation, RecoversALinearSystemAndSeesNoDistortion) {
  std::mt19937_64 random(3);
  const auto result = robust_approximation(
      averages(drives(LineGrid::full, 3, 1), {.squared = 0., .cubed = 0.}, 2, 0., 0., random));
  EXPECT_EQ(result.n_realisations, 3u);
  EXPECT_EQ(result.n_periods, 2u);
  for (std::size_t i = 0; i < result.response.value.size(); ++i) {
    EXPECT_LT(std::abs(result.response.value[i] - true_resonance(result.response.frequency_hz[i])),
              1e-10);
    EXPECT_LT(std::abs(result.distortion_variance[i]), 1e-20);
  }
}

// Of u + c u^3 with F flat random-phase lines of amplitude A the expected gain is exactly
// 1 + c (3 F A^2 / 2 - 3 A^2 / 4).
TEST(RobustApproximation, OfACubeIsTheKnownGain) {
  std::mt19937_64 random(3);
  const auto excitation = drives(LineGrid::full, 40, 5);
  double gain = 0., deviation = 0., n = 0.;
  const auto all = averages(excitation, {.cubed = 0.8, .resonant = false}, 1, 0., 0., random);
  const auto result = robust_approximation(all);
  double power = 0.;
  for (const auto& one : all) power += std::norm(one.input[20]) / 40.;
  const auto n_lines = static_cast<double>(result.response.value.size());
  for (std::size_t i = 0; i < result.response.value.size(); ++i, ++n) {
    gain += result.response.value[i].real() / n_lines;
    deviation += std::pow(result.response.standard_deviation[i] / n_lines, 2);
  }
  EXPECT_NEAR(gain, 1. + 0.8 * (1.5 * n_lines - 0.75) * power, 6. * std::sqrt(deviation));
  EXPECT_GT(gain, 1. + 20. * std::sqrt(deviation));
}

TEST(RobustApproximation, TellsDistortionFromNoiseAtTheirKnownLevels) {
  const WienerSystem system{.squared = 0.3, .cubed = 0.2};
  const double distortion = true_ensemble(system, LineGrid::full).variance;
  std::mt19937_64 random(9);
  constexpr std::size_t n_draws = 30, n_realisations = 6, n_periods = 3;
  double found = 0., noise = 0., expected_noise = 0.;
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    const auto excitation = drives(LineGrid::full, n_realisations, 100 + draw);
    const auto all = averages(excitation, system, n_periods, 0., 0.1, random);
    const auto result = robust_approximation(all);
    found += mean_of(result.distortion_variance) / n_draws;
    noise += mean_of(result.noise_variance) / n_draws;
    for (const auto& one : all)
      expected_noise += 4. * 0.01 / (period_length * n_periods) / std::norm(one.input[20]) /
                        (n_draws * n_realisations * n_realisations);
  }
  EXPECT_NEAR(found / distortion, 1., 0.1);
  EXPECT_NEAR(noise / expected_noise, 1., 0.05);
}

TEST(RobustApproximation, StatedDeviationIsThatOfTheErrorWithBothChannelsNoisy) {
  const WienerSystem system{.squared = 0.2, .cubed = 0.15};
  const auto truth = true_ensemble(system, LineGrid::full).mean;
  std::mt19937_64 random(11);
  constexpr std::size_t n_draws = 60;
  double error = 0., stated = 0.;
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    const auto result = robust_approximation(
        averages(drives(LineGrid::full, 5, 500 + draw), system, 2, 0.02, 0.05, random));
    for (std::size_t i = 0; i < truth.size(); ++i) {
      error += std::norm(result.response.value[i] - truth[i]);
      stated += std::pow(result.response.standard_deviation[i], 2);
    }
  }
  // 120 lines in 60 draws; what the truth itself, a mean of 1000, errs by is 5 / 1000.
  EXPECT_NEAR(error / stated, 1., 0.1);
}

TEST(RobustApproximation, CoversTheTruthAsOftenAsItsDegreesOfFreedomSay) {
  const WienerSystem system{.cubed = 0.2};
  const auto truth = true_ensemble(system, LineGrid::odd).mean;
  std::mt19937_64 random(13);
  constexpr std::size_t n_draws = 100, n_realisations = 6;
  // |e|^2 / s^2 follows F(2, 10); its 95 % point is 4.10.
  double covered = 0., n = 0.;
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    const auto result = robust_approximation(
        averages(drives(LineGrid::odd, n_realisations, 900 + draw), system, 2, 0., 0.1, random));
    for (std::size_t i = 0; i < truth.size(); ++i, ++n)
      covered += std::norm(result.response.value[i] - truth[i]) <
                 4.10 * std::pow(result.response.standard_deviation[i], 2);
  }
  EXPECT_NEAR(covered / n, 0.95, 0.015);
}

TEST(RobustApproximation, RefusesWhatHoldsNoAnswer) {
  std::mt19937_64 random(3);
  auto all = averages(drives(LineGrid::odd, 2, 1), {}, 2, 0., 0., random);
  EXPECT_NO_THROW(robust_approximation(all, {5, 7}));
  EXPECT_THAT([&] { robust_approximation(std::span(all).first(1)); },
              ThrowsMessage<UserError>(HasSubstr("two realisations")));
  EXPECT_THAT(
      [&] {
        robust_approximation(all, {5, 512});
      },
      ThrowsMessage<UserError>(HasSubstr("line 512 is not one of the lines 1 .. 511")));
  all[0].input[4] = 0.;
  EXPECT_THAT([&] { robust_approximation(all, {5}); },
              ThrowsMessage<UserError>(HasSubstr("input is zero at line 5")));
  all[1].period_samples = 512;
  EXPECT_THAT([&] { robust_approximation(all); },
              ThrowsMessage<UserError>(HasSubstr("periods of 1024 and 512")));
}

std::vector<std::size_t> excited_lines(const DesignedExcitation& excitation) {
  std::vector<std::size_t> orders;
  for (const auto& line : excitation.lines)
    if (line.role == LineRole::excited) orders.push_back(line.order);
  return orders;
}

/// Sums over all draws of one system's fast analyses, each with a new grid and new phases.
struct FastSums {
  double error = 0., stated = 0., even = 0., odd = 0., noise = 0., n = 0.;
};
FastSums fast_sums(const WienerSystem& system, const std::vector<Complex>& truth,
                   double input_noise, double output_noise, std::size_t n_draws) {
  std::mt19937_64 random(17);
  FastSums sums;
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    const auto excitation = drives(LineGrid::random_odd, 1, 300 + draw);
    const auto result = fast_approximation(
        measure(excitation.drives[0].period, system, 4, input_noise, output_noise, random)
            .average(),
        {.excited = excited_lines(excitation)});
    for (std::size_t i = 0; i < result.response.value.size(); ++i) {
      const double hz = result.response.frequency_hz[i];
      const auto line = static_cast<std::size_t>(std::lround(hz * period_length / rate_hz));
      if (!truth.empty()) {
        sums.error += std::norm(result.response.value[i] - truth[(line - 3) / 2]);
        sums.stated += std::pow(result.response.standard_deviation[i], 2);
      }
      sums.even += result.even_power[i];
      sums.odd += result.odd_power[i];
      sums.noise += result.noise_power[i];
      ++sums.n;
    }
  }
  return sums;
}

TEST(FastApproximation, RecoversALinearSystemAndSeesNoDistortion) {
  const auto sums = fast_sums({}, {}, 0., 0., 1);
  EXPECT_LT(std::abs(sums.even), 1e-20);
  EXPECT_LT(std::abs(sums.odd), 1e-20);
  EXPECT_LT(sums.noise, 1e-20);
}

TEST(FastApproximation, NoiseAloneIsNoDistortion) {
  const auto sums = fast_sums({}, {}, 0., 0.1, 40);
  const double noise = 4. * 0.01 / (period_length * 4);
  EXPECT_NEAR(sums.noise / sums.n / noise, 1., 0.05);
  EXPECT_NEAR(sums.even / sums.n / noise, 0., 0.1);
  EXPECT_NEAR(sums.odd / sums.n / noise, 0., 0.15);
}

TEST(FastApproximation, ASquareShowsAtTheEvenLinesAndACubeAtTheOddOnes) {
  const auto square = fast_sums({.squared = 0.3}, {}, 0., 0., 10);
  EXPECT_GT(square.even / square.n, 1e-6);
  EXPECT_LT(std::abs(square.odd), 1e-20 * square.even);
  const auto cube = fast_sums({.cubed = 0.3}, {}, 0., 0., 10);
  EXPECT_GT(cube.odd / cube.n, 1e-8);
  EXPECT_LT(std::abs(cube.even), 1e-20 * cube.odd);
}

// u^2 of random-phase cosines of amplitude A, over A^2: every pair of lines gives amplitude 1 at
// its sum and its difference, each line 1/2 at its double, all with independent phases.
double mean_power_of_square(const std::vector<std::size_t>& excited, std::size_t line) {
  double power = 0.;
  for (const auto i : excited)
    for (const auto j : excited) {
      if (i < j && (i + j == line || j - i == line)) power += 1.;
      if (i == j && i + j == line) power += 0.25;
    }
  return power;
}

TEST(FastApproximation, TheSquareHasItsKnownLevel) {
  const auto excitation = drives(LineGrid::random_odd, 200, 4);
  const auto lines = excited_lines(excitation);
  std::mt19937_64 random(1);
  double found = 0., wanted = 0.;
  for (const Drive& drive : excitation.drives) {
    const auto average =
        measure(drive.period, {.squared = 0.5, .resonant = false}, 2, 0., 0., random).average();
    const double amplitude_squared = std::norm(average.input[lines[0] - 1]);
    for (const auto& line : fast_approximation(average).detection) {
      if (line.role != LineRole::even_detection) continue;
      // Over A^4, because drives that crest higher have both less amplitude and more distortion.
      found += line.power / (amplitude_squared * amplitude_squared);
      wanted += 0.25 * mean_power_of_square(lines, line.order);
    }
  }
  EXPECT_NEAR(found / wanted, 1., 0.03);
}

TEST(FastApproximation, StatedDeviationIsThatOfTheErrorFromNoiseAndOddDistortion) {
  const WienerSystem system{.squared = 0.2, .cubed = 0.1, .resonant = false};
  std::vector<Complex> truth(61);
  // The mean over many grids and phases at every odd line from 3 on.
  std::vector<double> count(truth.size(), 0.);
  std::mt19937_64 random(2);
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    const auto drive = drives(LineGrid::random_odd, 1, 5000 + seed).drives[0].period;
    const auto average = measure(drive, system, 1, 0., 0., random).average();
    for (const auto line : excited_orders(average)) {
      truth[(line - 3) / 2] += average.response(line);
      ++count[(line - 3) / 2];
    }
  }
  for (std::size_t i = 0; i < truth.size(); ++i) truth[i] /= std::max(1., count[i]);
  const auto quiet = fast_sums(system, truth, 0., 0.005, 300);
  EXPECT_NEAR(quiet.error / quiet.stated, 1., 0.15);
  const auto noisy = fast_sums(system, truth, 0.02, 0.1, 300);
  EXPECT_NEAR(noisy.error / noisy.stated, 1., 0.1);
  EXPECT_GT(noisy.stated, 3. * quiet.stated);
}

TEST(FastApproximation, InputThatLeaksIntoDetectionLinesIsNoDistortion) {
  auto drive = drives(LineGrid::random_odd, 1, 4).drives[0].period;
  for (double& u : drive) u += 0.05 * u * u;  // a shaker that distorts before the accelerometer
  std::mt19937_64 random(2);
  const auto leaking = measure(drive, {.resonant = false}, 2, 0., 0., random).average();
  const auto result = fast_approximation(leaking, {.excitation_threshold = 0.05});
  EXPECT_THAT(result.even_power, Each(testing::Lt(1e-25)));
  double leaked = 0.;
  for (const auto& line : result.detection) leaked += std::norm(leaking.input[line.order - 1]);
  EXPECT_GT(leaked, 1e-6);
}

TEST(FastApproximation, OnTheOddGridKnowsEvenDistortionAlone) {
  std::mt19937_64 random(2);
  const auto drive = drives(LineGrid::odd, 1, 4).drives[0].period;
  const auto result =
      fast_approximation(measure(drive, {.cubed = 0.1}, 2, 0., 0., random).average());
  EXPECT_THAT(result.odd_power, IsEmpty());
  EXPECT_EQ(result.even_power.size(), result.response.value.size());
}

TEST(FastApproximation, RefusesWhatHoldsNoAnswer) {
  std::mt19937_64 random(2);
  const auto average = [&](LineGrid grid, std::size_t n_periods) {
    return measure(drives(grid, 1, 4).drives[0].period, {}, n_periods, 0., 0., random).average();
  };
  const auto fast = [](PeriodAverage of, FastOptions options = {}) {
    return [=] { fast_approximation(of, options); };
  };
  EXPECT_THAT(fast(average(LineGrid::random_odd, 1)),
              ThrowsMessage<UserError>(HasSubstr("two periods")));
  EXPECT_THAT(
      fast(average(LineGrid::full, 2)),
      ThrowsMessage<UserError>(HasSubstr("is excited, but the method needs a random-odd grid")));
  EXPECT_THAT(fast(average(LineGrid::random_odd, 2), {.n_averaged = 1000}),
              ThrowsMessage<UserError>(HasSubstr("1000 are to be averaged")));
  EXPECT_THAT(fast(average(LineGrid::random_odd, 2), {.n_averaged = 0}),
              ThrowsMessage<UserError>(HasSubstr("at least 1")));
}

}  // namespace
}  // namespace vibrissa::signals
