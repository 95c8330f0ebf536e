#include "separation/identification/identify_frequency.h"

#include <gmock/gmock.h>

#include "separation/model/simulation.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::FrequencyResponse;
using signals::UserError;
using testing::HasSubstr;
using testing::ThrowsMessage;

using test::rate_hz;

std::vector<double> grid(double low_hz, double high_hz, double step_hz) {
  std::vector<double> frequency;
  for (double f = low_hz; f < high_hz; f += step_hz) frequency.push_back(f);
  return frequency;
}

FrequencyResponse exact_response(const Bvrm& model, const std::vector<double>& frequency_hz) {
  FrequencyResponse result;
  result.frequency_hz = frequency_hz;
  result.value = response(model, frequency_hz);
  return result;
}

void expect_modes(const FittedBvrm& fit, const Bvrm& truth, double tolerance) {
  ASSERT_EQ(fit.model.modes.size(), truth.modes.size());
  std::vector<ModalTerm> modes = truth.modes;
  std::ranges::sort(modes, {}, &ModalTerm::a0);
  for (std::size_t k = 0; k < modes.size(); ++k) {
    EXPECT_NEAR(fit.model.modes[k].frequency_hz() / modes[k].frequency_hz(), 1., tolerance);
    EXPECT_NEAR(fit.model.modes[k].damping_ratio() / modes[k].damping_ratio(), 1., tolerance);
    EXPECT_NEAR(fit.model.modes[k].b0 / modes[k].b0, 1., tolerance);
  }
}

// Central differences of the cost, whose error falls with the square of the step.
TEST(FrequencyProblem, HasTheGradientOfItsCost) {
  const Bvrm model = test::sensor(2, -2e-7), other = test::sensor(1, 1e-7);
  const auto measured = exact_response(other, grid(1., 240., 3.));
  for (const std::optional<Sampling> sampling :
       {std::optional<Sampling>{}, std::optional(Sampling{rate_hz, Hold::first_order}),
        std::optional(Sampling{rate_hz, Hold::zero_order})}) {
    const FrequencyProblem problem(measured, sampling, true, 0.0027);
    const Eigen::VectorXd at = to_parameters(model, true);
    NormalEquations here, there;
    ASSERT_TRUE(problem.linearise(at, here));
    EXPECT_NEAR(here.cost, problem.residual(at).squaredNorm(), 1e-12 * here.cost);
    const auto difference = [&](Eigen::Index i, double step) {
      Eigen::VectorXd moved = at;
      moved[i] += step;
      problem.linearise(moved, there);
      const double up = there.cost;
      moved[i] -= 2. * step;
      problem.linearise(moved, there);
      return -(up - there.cost) / (4. * step);
    };
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const double step = 1e-3 * std::sqrt(here.cost / here.matrix(i, i));
      const double size = std::sqrt(here.cost * here.matrix(i, i));
      EXPECT_NEAR(difference(i, step), here.gradient[i], 1e-4 * size) << i;
      EXPECT_NEAR(difference(i, step / 2.), here.gradient[i], 3e-5 * size) << i;
    }
  }
}

TEST(IdentifyFrequency, RecoversOneToThreeModesAndTheDirectTermWithoutStartingValues) {
  for (std::size_t n_modes = 1; n_modes <= 3; ++n_modes) {
    const Bvrm truth = test::sensor(n_modes, -2e-7);
    const auto measured = exact_response(truth, grid(1., 240., 0.7));
    const FittedBvrm fit = identify_frequency(measured, {.order = 2 * n_modes});
    EXPECT_EQ(fit.end, FitEnd::converged);
    expect_modes(fit, truth, 1e-8);
    EXPECT_NEAR(fit.model.direct_term_kg_m / -2e-7, 1., 1e-7);
  }
}

TEST(IdentifyFrequency, FindsTheWhiskersModesWithTheThirdAboveTheBand) {
  Bvrm truth;
  truth.modes = {make_modal_term(27.2, 0.05, -9e-6, -3e-9), make_modal_term(172., 0.05, -8e-7),
                 make_modal_term(466., 0.05, -1e-7)};
  const FittedBvrm fit =
      identify_frequency(exact_response(truth, grid(1., 230., 0.5)), {.order = 4});
  EXPECT_NEAR(fit.modes[0].frequency_hz.value, 27.2, 0.01);
  EXPECT_NEAR(fit.modes[1].frequency_hz.value, 172., 0.5);
  // What is left of the third mode far below its resonance.
  EXPECT_NEAR(fit.model.direct_term_kg_m, -1e-7, 3e-8);
}

TEST(IdentifyFrequency, FindsTwoCloseAndTwoStronglyDampedModes) {
  Bvrm close, damped;
  close.modes = {make_modal_term(30., 0.02, 1e-6), make_modal_term(31.5, 0.02, -1e-6)};
  damped.modes = {make_modal_term(20., 0.6, 1e-6), make_modal_term(120., 1.5, 1e-6)};
  expect_modes(identify_frequency(exact_response(close, grid(1., 240., 0.5)), {.order = 4}), close,
               1e-6);
  expect_modes(identify_frequency(exact_response(damped, grid(1., 240., 0.5)), {.order = 4}),
               damped, 1e-5);
}

TEST(IdentifyFrequency, FitsASparseSetOfLines) {
  const Bvrm truth = test::sensor(1);
  const auto measured = exact_response(truth, {12., 15., 19., 23., 26., 29.});
  expect_modes(identify_frequency(measured, {.order = 2}), truth, 1e-8);
}

TEST(IdentifyFrequency, KnowsTheResponseOfSamplesFromThatOfTheContinuousSignal) {
  Bvrm truth = test::sensor(2, -2e-7);
  truth.delay_s = 0.0031;
  for (const Hold hold : {Hold::first_order, Hold::zero_order}) {
    const std::size_t period = 1000;
    const test::Lines lines(2., 240., 120, 8);
    test::Lines periodic = lines;
    for (double& f : periodic.frequency_hz) f = std::round(2. * f) / 2.;
    const auto input = periodic.sample(20 * period, rate_hz);
    const auto output = simulate(truth, input, rate_hz, hold);
    const std::span<const double> u(input), y(output);
    const auto measured =
        signals::periodic_response(u.last(2 * period), y.last(2 * period), rate_hz, period);
    const FittedBvrm fit = identify_frequency(
        measured, {.order = 4, .delay_s = truth.delay_s, .sampling = Sampling{rate_hz, hold}});
    expect_modes(fit, truth, 1e-6);
    const FittedBvrm naive = identify_frequency(measured, {.order = 4, .delay_s = truth.delay_s});
    EXPECT_GT(std::abs(naive.model.modes[1].b0 / truth.modes[1].b0 - 1.), 0.05);
  }
}

TEST(IdentifyFrequency, SeesTheSignOfThePhase) {
  const Bvrm truth = test::sensor(1);
  auto conjugate = exact_response(truth, grid(1., 240., 1.));
  for (auto& value : conjugate.value) value = std::conj(value);
  const FittedBvrm fit = identify_frequency(conjugate, {.order = 2});
  EXPECT_GT(fit.residual_variance, 0.01) << "no stable mode has a leading phase";
}

TEST(IdentifyFrequency, StatesTheScatterOfItsEstimates) {
  const Bvrm truth = test::sensor(1, -2e-7);
  const auto exact = exact_response(truth, grid(1., 240., 1.));
  double square = 0., stated = 0.;
  constexpr int n_draws = 100;
  for (int draw = 0; draw < n_draws; ++draw) {
    auto noisy = exact;
    const auto re = test::white_noise(exact.value.size(), 1., 2 * draw + 1);
    const auto im = test::white_noise(exact.value.size(), 1., 2 * draw + 2);
    for (std::size_t k = 0; k < re.size(); ++k) {
      // Louder above 100 Hz: the weights must tell.
      const double sd = k < 100 ? 1e-7 : 1e-6;
      noisy.standard_deviation.push_back(sd);
      noisy.value[k] += sd / std::sqrt(2.) * std::complex<double>(re[k], im[k]);
    }
    const FittedBvrm fit = identify_frequency(noisy, {.order = 2});
    square += std::pow(fit.modes[0].frequency_hz.value - 31.47, 2) / n_draws;
    stated += std::pow(fit.modes[0].frequency_hz.standard_deviation, 2) / n_draws;
    EXPECT_NEAR(fit.residual_variance, 1., 0.3);
  }
  // The ratio of two such roots scatters by 1 / sqrt(2 n_draws) = 7 %.
  EXPECT_NEAR(std::sqrt(square / stated), 1., 0.2);
}

TEST(IdentifyFrequency, LeavesLinesWithoutAValueOut) {
  const Bvrm truth = test::sensor(1);
  auto measured = exact_response(truth, grid(1., 240., 1.));
  measured.value[20] = std::numeric_limits<double>::quiet_NaN();
  expect_modes(identify_frequency(measured, {.order = 2}), truth, 1e-8);
}

TEST(IdentifyFrequency, RefusesWhatDoesNotDetermineAModel) {
  const auto measured = exact_response(test::sensor(1), {10., 20., 30., 40.});
  EXPECT_THAT([&] { identify_frequency(measured, {.order = 3}); },
              ThrowsMessage<UserError>(HasSubstr("order = 3")));
  EXPECT_THAT([&] { identify_frequency(measured, {.order = 0}); },
              ThrowsMessage<UserError>(HasSubstr("order = 0")));
  EXPECT_THAT([&] { identify_frequency(measured, {.order = 4}); },
              ThrowsMessage<UserError>(HasSubstr("4 lines do not determine a model of order 4")));
  auto unordered = measured;
  std::swap(unordered.frequency_hz[1], unordered.frequency_hz[2]);
  EXPECT_THAT([&] { identify_frequency(unordered, {.order = 2}); },
              ThrowsMessage<UserError>(HasSubstr("not above the frequency before")));
  auto short_value = measured;
  short_value.value.pop_back();
  EXPECT_THAT([&] { identify_frequency(short_value, {.order = 2}); },
              ThrowsMessage<UserError>(HasSubstr("4 frequencies, 3 values")));
  auto zero = measured;
  zero.value.assign(4, 0.);
  EXPECT_THAT([&] { identify_frequency(zero, {.order = 2}); },
              ThrowsMessage<UserError>(HasSubstr("zero at every line")));
}

}  // namespace
}  // namespace vibrissa::separation
