// Noise on both channels, and common to them: the frequency fit of a periodic record weighs each
// line with the variance of M - G a between periods, var M + |G|^2 var a - 2 Re(G* cov), and is
// then the maximum-likelihood estimate of errors in variables (Pintelon & Schoukens 2012, chapter
// 9) to first order in the noise. The bound is computed here from the noise that was made and from
// differences of the response.
#include <gmock/gmock.h>

#include <Eigen/Dense>

#include "separation/identification/identify_frequency.h"
#include "separation/identification/output_error.h"
#include "signals/spectra/fft.h"
#include "signals/spectra/frequency_response.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

using test::rate_hz;
constexpr std::size_t samples_of_period = 500, n_periods = 20, periods_to_settle = 6;

Signal drive() {
  const Signal one = test::Lines(1., 249., 249, 1).sample(samples_of_period, rate_hz);
  Signal all;
  for (std::size_t i = 0; i < periods_to_settle + n_periods; ++i)
    all.insert(all.end(), one.begin(), one.end());
  return all;
}

Signal steady(const Signal& x) {
  return {x.begin() + periods_to_settle * samples_of_period, x.end()};
}

Eigen::VectorXcd line_response(const Bvrm& model, const Signal& input) {
  const auto response = signals::periodic_response(
      steady(input), steady(simulate(model, input, rate_hz)), rate_hz, samples_of_period);
  return Eigen::Map<const Eigen::VectorXcd>(response.value.data(),
                                            static_cast<Eigen::Index>(response.value.size()));
}

// Noise of the moment and of the accelerometer, and their covariance.
struct Noise {
  double moment, acceleration, covariance;
};

// Standard deviations of (b1, b0, a1, a0, D).
Eigen::VectorXd bound(const Bvrm& truth, const Signal& input, const Noise& noise) {
  const Eigen::VectorXcd g = line_response(truth, input);
  const auto spectrum = signals::real_fft(std::span(input).first(samples_of_period));
  const Eigen::VectorXd at = to_parameters(truth, true);
  Eigen::MatrixXcd derivative(g.size(), at.size());
  Eigen::VectorXd step(5);
  step << 1e-9, 1e-3 * at[1], 1e-3 * at[2], 1e-5 * at[3], 1e-9;
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    Eigen::VectorXd up = at, down = at;
    up[j] += step[j];
    down[j] -= step[j];
    derivative.col(j) = (line_response(with_parameters(up, true, 0.), input) -
                         line_response(with_parameters(down, true, 0.), input)) /
                        (2. * step[j]);
  }
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(at.size(), at.size());
  for (Eigen::Index k = 0; k < g.size(); ++k) {
    const double variance =
        (noise.moment * noise.moment + std::norm(g[k]) * std::pow(noise.acceleration, 2) -
         2. * g[k].real() * noise.covariance) *
        samples_of_period / (n_periods * std::norm(spectrum[static_cast<std::size_t>(k) + 1]));
    information += 2. / variance * (derivative.row(k).adjoint() * derivative.row(k)).real();
  }
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  return scaled.inverse().diagonal().cwiseSqrt().cwiseProduct(scale);
}

TEST(ErrorsInVariables, FrequencyFitReachesTheirBoundWhereOutputErrorIsBiased) {
  const Bvrm truth = test::sensor(1, -2e-7);
  const Signal input = drive(), motion = steady(input),
               moment = steady(simulate(truth, input, rate_hz));
  // A disturbance common to both channels, and one for each.
  const double common = 0.02 * test::rms(motion), own = 0.1 * test::rms(motion);
  const double to_moment = -2e-5, moment_noise = 0.01 * test::rms(moment);
  const Noise noise{.moment = std::hypot(moment_noise, to_moment * common),
                    .acceleration = std::hypot(own, common),
                    .covariance = to_moment * common * common};
  const Eigen::VectorXd deviation = bound(truth, input, noise),
                        expected = to_parameters(truth, true);

  constexpr int n_draws = 200;
  Eigen::VectorXd square = Eigen::VectorXd::Zero(5), mean = square;
  double output_error_gain = 0.;
  for (std::uint64_t i = 0; i < n_draws; ++i) {
    const Signal shared = test::white_noise(motion.size(), common, 3 * i + 1);
    Signal a = test::plus_noise(motion, own, 3 * i + 2);
    Signal m = test::plus_noise(moment, moment_noise, 3 * i + 3);
    for (std::size_t n = 0; n < a.size(); ++n) a[n] += shared[n], m[n] += to_moment * shared[n];
    const FittedBvrm fit =
        identify_frequency(signals::periodic_response(a, m, rate_hz, samples_of_period),
                           {.sampling = Sampling{.rate_hz = rate_hz, .hold = Hold::first_order}});
    const Eigen::VectorXd error =
        (to_parameters(fit.model, true) - expected).cwiseQuotient(deviation);
    square += error.cwiseAbs2() / n_draws;
    mean += error / n_draws;
    if (i < 20) {
      const Segment segment{a, m};
      output_error_gain +=
          refine_output_error(truth, std::span(&segment, 1), rate_hz).model.modes[0].b0 /
          (20. * truth.modes[0].b0);
    }
  }
  // The root of 200 squares scatters by 5 %, their mean by 0.07.
  for (const Eigen::Index j : {1, 2, 3}) {
    RecordProperty("error_over_bound_" + std::to_string(j), std::to_string(std::sqrt(square[j])));
    EXPECT_LT(std::sqrt(square[j]), 1.15) << j;
    EXPECT_GT(std::sqrt(square[j]), 0.85) << j;
    EXPECT_LT(std::abs(mean[j]), 0.3) << j;
  }
  // Output error takes the accelerometer's noise, a hundredth of the power, for motion.
  EXPECT_NEAR(output_error_gain, 1. - 0.01, 0.003);
}

}  // namespace
}  // namespace vibrissa::separation
