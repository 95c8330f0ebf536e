#include "separation/nonlinear/nonlinear_fit.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"
#include "tests/separation/nonlinear/oscillator.h"

namespace vibrissa::separation {
namespace {

using test::rate_hz;
using test::Shaken;

constexpr double cubic_per_m2_s2 = 4e9, drag_per_m = 40.;

double hard_and_dragged(double x, double v) {
  return cubic_per_m2_s2 * x * x * x + drag_per_m * v * std::abs(v);
}

NonlinearBvrm guess(LawReadout readout) {
  NonlinearBvrm model{
      .linear = {},
      .mode = 0,
      .law = {{.kind = LawKind::cubic_stiffness}, {.kind = LawKind::quadratic_damping}},
      .readout = readout};
  model.linear.modes = {make_modal_term(32., 0.035, -8e-6)};
  return model;
}

constexpr OutputErrorOptions elastic_fit{
    .hold = Hold::band_limited, .direct_term = false, .viscous_term = false};

TEST(NonlinearFit, FindsTheParametersOfADuffingOscillatorWithinThreeDeviations) {
  for (const bool moment : {true, false}) {
    Shaken shaken(test::shaken_mode(), hard_and_dragged, moment, 4000, 1., moment ? 1 : 2);
    shaken.add_noise(0.01, 3);
    const Segment segment = shaken.segment();
    const auto fit = refine_nonlinear(guess(moment ? LawReadout::moment : LawReadout::deflection),
                                      std::span(&segment, 1), rate_hz, elastic_fit);
    ASSERT_EQ(fit.end, FitEnd::converged);
    const ModalTerm truth = test::shaken_mode(), &found = fit.model.linear.modes[0];
    const auto expect = [&](double value, double true_value, Eigen::Index i) {
      const double deviation = std::sqrt(fit.covariance(i, i));
      EXPECT_LT(deviation, 0.1 * std::abs(true_value)) << i;
      EXPECT_LT(std::abs(value - true_value), 3. * deviation) << i << " " << moment;
    };
    expect(found.b0, truth.b0, 1);
    expect(found.a1, truth.a1, 2);
    expect(found.a0, truth.a0, 3);
    expect(fit.model.law[0].coefficient, cubic_per_m2_s2, 5);
    expect(fit.model.law[1].coefficient, drag_per_m, 6);
    EXPECT_EQ(fit.covariance(0, 0), 0.);
    EXPECT_EQ(fit.covariance(4, 4), 0.);
    EXPECT_DOUBLE_EQ(fit.coefficient_deviation(1), std::sqrt(fit.covariance(6, 6)));
    EXPECT_NEAR(std::sqrt(fit.residual_variance), 0.01 * test::rms(shaken.moment),
                5e-4 * test::rms(shaken.moment));
  }
}

TEST(NonlinearFit, HasTheGradientOfItsCost) {
  const Shaken shaken(test::shaken_mode(), hard_and_dragged, true, 600, 1., 4);
  const std::vector<Segment> segments{
      {std::span(shaken.acceleration).first(250), std::span(shaken.moment).first(250)},
      {std::span(shaken.acceleration).subspan(250), std::span(shaken.moment).subspan(250)}};
  for (const Hold hold : {Hold::first_order, Hold::band_limited}) {
    NonlinearBvrm model = guess(LawReadout::moment);
    model.linear.modes.push_back(make_modal_term(90., 0.1, -1e-6, 1e-9));
    model.linear.direct_term_kg_m = 1e-8;
    model.linear.delay_s = 0.0027;
    model.law[0].coefficient = 1e9;
    model.law[1].coefficient = 10.;
    NonlinearProblem problem(model, segments, rate_hz, {.hold = hold});
    Eigen::VectorXd at = problem.start_of(model);
    for (Eigen::Index i = problem.n_model_parameters(); i < at.size(); ++i) at[i] = 1e-6;
    NormalEquations here, near;
    ASSERT_TRUE(problem.linearise(at, here));
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const double h = 1e-6 * std::max(std::abs(at[i]), 1e-9);
      std::array<double, 2> cost;
      for (const int side : {0, 1}) {
        Eigen::VectorXd moved = at;
        moved[i] += side ? h : -h;
        ASSERT_TRUE(problem.linearise(moved, near));
        cost[static_cast<std::size_t>(side)] = near.cost;
      }
      const double scale = std::sqrt(here.matrix(i, i) * here.cost);
      EXPECT_NEAR((cost[0] - cost[1]) / (4. * h) / scale, here.gradient[i] / scale, 1e-4)
          << i << " " << to_string(hold);
    }
  }
}

TEST(NonlinearFit, ScoresWithOnlyStateAndOffsetUnknown) {
  const Shaken shaken(test::shaken_mode(), hard_and_dragged, true, 3000, 1., 5);
  NonlinearBvrm truth = guess(LawReadout::moment);
  truth.linear.modes = {test::shaken_mode()};
  truth.law[0].coefficient = cubic_per_m2_s2;
  truth.law[1].coefficient = drag_per_m;
  const Segment part{std::span(shaken.acceleration).subspan(1000),
                     std::span(shaken.moment).subspan(1000)};
  const auto errors = nonlinear_errors(truth, std::span(&part, 1), rate_hz, elastic_fit);
  // Beyond the ends of the record the band-limited input is not known.
  EXPECT_LT(test::rms(std::span(errors[0]).subspan(500, 1400)), 1e-3 * test::rms(shaken.moment));
}

TEST(NonlinearFit, RefusesTooFewSamplesAndAStartThatDiverges) {
  const Shaken shaken(test::shaken_mode(), hard_and_dragged, true, 300, 1., 6);
  const Segment few{std::span(shaken.acceleration).first(8), std::span(shaken.moment).first(8)};
  const Segment all = shaken.segment();
  const auto refine = [&](const NonlinearBvrm& start, const Segment& segment) {
    refine_nonlinear(start, std::span(&segment, 1), rate_hz, {});
  };
  EXPECT_THAT([&] { refine(guess(LawReadout::moment), few); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("too few")));
  NonlinearBvrm soft = guess(LawReadout::moment);
  soft.law[0].coefficient = -1e15;
  EXPECT_THAT([&] { refine(soft, all); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("diverges")));
}

}  // namespace
}  // namespace vibrissa::separation
