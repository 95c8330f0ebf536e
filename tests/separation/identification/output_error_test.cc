#include "separation/identification/output_error.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>

#include "separation/identification/output_error_problem.h"
#include "signals/base/error.h"
#include "tests/separation/fitted_models.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::disturbed;
using test::expect_equal_models;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

using test::rate_hz;

TEST(OutputError, FitsSeveralSegmentsWithDifferentOffsetsAsOne) {
  const Bvrm truth = test::sensor(2, -2e-7);
  std::vector<Signal> inputs, outputs;
  std::vector<Segment> segments;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    inputs.push_back(test::white_noise(400 + 100 * seed, 3., seed));
    const std::vector<ModalState> states{{1e-3 * static_cast<double>(seed), 0.}, {}};
    outputs.push_back(simulate(truth, inputs.back(), rate_hz, Hold::first_order, states));
    for (double& m : outputs.back()) m += 1e-5 * static_cast<double>(seed);
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) segments.push_back({inputs[i], outputs[i]});
  expect_equal_models(refine_output_error(disturbed(truth), segments, rate_hz), truth, 1e-8);
}

// The gradient of the cost against central differences, whose error falls with the square of the
// step.
TEST(OutputErrorProblem, HasTheGradientOfItsCost) {
  const Bvrm model = test::sensor(2, -2e-7);
  const Signal input = test::white_noise(700, 3., 4);
  const Signal output = test::plus_noise(simulate(model, input, rate_hz), 1e-5, 5);
  const Segment segment{input, output};
  for (const Hold hold : {Hold::first_order, Hold::zero_order, Hold::band_limited})
    for (const bool free : {true, false})
      for (const double delay_s : {0., 0.0013}) {
        OutputErrorProblem problem(2, delay_s, std::span(&segment, 1), rate_hz,
                                   {.hold = hold, .nuisance = {.initial_state = free}});
        Eigen::VectorXd unknowns = Eigen::VectorXd::Constant(problem.n_unknowns(), 1e-6);
        unknowns.head(problem.n_model_parameters()) = to_parameters(disturbed(model), true);
        NormalEquations here, there;
        ASSERT_TRUE(problem.linearise(unknowns, here));
        const auto difference = [&](Eigen::Index i, double step) {
          Eigen::VectorXd moved = unknowns;
          moved[i] += step;
          problem.linearise(moved, there);
          const double up = there.cost;
          moved[i] -= 2. * step;
          problem.linearise(moved, there);
          return -(up - there.cost) / (4. * step);
        };
        for (Eigen::Index i = 0; i < unknowns.size(); ++i) {
          // A step that changes the output by a thousandth of the error.
          const double step = 1e-2 * std::sqrt(here.cost / here.matrix(i, i));
          const double size = std::sqrt(here.cost * here.matrix(i, i));
          const double coarse = difference(i, step) - here.gradient[i];
          const double fine = difference(i, step / 2.) - here.gradient[i];
          EXPECT_LT(std::abs(fine), 1e-3 * size);
          if (std::abs(coarse) > 1e-8 * size) {
            EXPECT_NEAR(coarse / fine, 4., 0.5) << i;
          }
        }
      }
}

// Bound and estimate of the same experiment. The bound comes from finite differences of the
// simulated output, which share nothing with the sensitivities of the fit.
struct Bound {
  double frequency_hz, damping_ratio;
};

Bound cramer_rao(const Bvrm& truth, const Signal& input, double noise) {
  const auto n = static_cast<Eigen::Index>(input.size());
  Eigen::MatrixXd jacobian(n, 8);
  const auto simulated = [&](const Eigen::VectorXd& p) {
    Bvrm model = truth;
    const double omega = 2. * std::numbers::pi * p[0];
    model.modes[0] = {.b1 = p[3], .b0 = p[2], .a1 = 2. * p[1] * omega, .a0 = omega * omega};
    model.direct_term_kg_m = p[4];
    const std::vector<ModalState> state{{p[5], p[6]}};
    Signal moment = simulate(model, input, rate_hz, Hold::first_order, state);
    for (double& m : moment) m += p[7];
    return moment;
  };
  Eigen::VectorXd at(8), step(8);
  const ModalTerm& mode = truth.modes[0];
  at << mode.frequency_hz(), mode.damping_ratio(), mode.b0, mode.b1, truth.direct_term_kg_m, 0., 0.,
      0.;
  step << 1e-4, 1e-6, 1e-3 * mode.b0, 1e-10, 1e-9, 1e-5, 1e-3, 1e-6;
  for (Eigen::Index j = 0; j < 8; ++j) {
    Eigen::VectorXd up = at, down = at;
    up[j] += step[j];
    down[j] -= step[j];
    const Signal difference = test::minus(simulated(up), simulated(down));
    for (Eigen::Index i = 0; i < n; ++i)
      jacobian(i, j) = difference[static_cast<std::size_t>(i)] / (2. * step[j]);
  }
  const Eigen::VectorXd length = jacobian.colwise().norm();
  jacobian.array().rowwise() /= length.transpose().array();
  const Eigen::MatrixXd inverse = (jacobian.transpose() * jacobian).inverse();
  return {.frequency_hz = noise * std::sqrt(inverse(0, 0)) / length[0],
          .damping_ratio = noise * std::sqrt(inverse(1, 1)) / length[1]};
}

TEST(OutputError, ReachesTheCramerRaoBoundAndStatesIt) {
  const Bvrm truth = test::sensor(1, -2e-7);
  const Signal input = test::white_noise(5000, 3., 11);
  const Signal clean = simulate(truth, input, rate_hz);
  constexpr int n_draws = 100;
  for (const double snr_db : {20., 40.}) {
    const double noise = test::rms(clean) * std::pow(10., -snr_db / 20.);
    const Bound bound = cramer_rao(truth, input, noise);
    double f = 0., zeta = 0., stated_f = 0., stated_zeta = 0.;
    for (int draw = 0; draw < n_draws; ++draw) {
      const Signal output = test::plus_noise(clean, noise, 1000 + draw);
      const Segment segment{input, output};
      const FittedBvrm fit = refine_output_error(disturbed(truth), std::span(&segment, 1), rate_hz);
      EXPECT_EQ(fit.end, FitEnd::converged);
      const ModeEstimate& mode = fit.modes[0];
      f += std::pow(mode.frequency_hz.value - 31.47, 2) / n_draws;
      zeta += std::pow(mode.damping_ratio.value - 0.027, 2) / n_draws;
      stated_f += std::pow(mode.frequency_hz.standard_deviation, 2) / n_draws;
      stated_zeta += std::pow(mode.damping_ratio.standard_deviation, 2) / n_draws;
    }
    RecordProperty("f_over_bound_" + std::to_string(static_cast<int>(snr_db)) + "dB",
                   std::to_string(std::sqrt(f) / bound.frequency_hz));
    RecordProperty("zeta_over_bound_" + std::to_string(static_cast<int>(snr_db)) + "dB",
                   std::to_string(std::sqrt(zeta) / bound.damping_ratio));
    // The root of a mean of 100 squares scatters by 7 %: 0.85 and 1.15 are two such.
    EXPECT_LT(std::sqrt(f) / bound.frequency_hz, 1.15);
    EXPECT_GT(std::sqrt(f) / bound.frequency_hz, 0.85);
    EXPECT_LT(std::sqrt(zeta) / bound.damping_ratio, 1.15);
    EXPECT_GT(std::sqrt(zeta) / bound.damping_ratio, 0.85);
    EXPECT_NEAR(std::sqrt(stated_f) / bound.frequency_hz, 1., 0.02);
    EXPECT_NEAR(std::sqrt(stated_zeta) / bound.damping_ratio, 1., 0.02);
  }
}

TEST(OutputError, DoesNotDependOnTheUnitOfTheMoment) {
  const Bvrm truth = test::sensor(1, -2e-7);
  const Signal input = test::white_noise(1000, 3., 12);
  const Signal output = test::plus_noise(simulate(truth, input, rate_hz), 1e-6, 13);
  Signal small = output;
  for (double& m : small) m *= 1e-6;
  const Segment segment{input, output}, small_segment{input, small};
  const FittedBvrm fit = refine_output_error(disturbed(truth), std::span(&segment, 1), rate_hz);
  const FittedBvrm small_fit =
      refine_output_error(disturbed(truth), std::span(&small_segment, 1), rate_hz);
  EXPECT_NEAR(small_fit.model.modes[0].a0 / fit.model.modes[0].a0, 1., 1e-9);
  EXPECT_NEAR(small_fit.model.modes[0].b0 / (1e-6 * fit.model.modes[0].b0), 1., 1e-6);
}

TEST(OutputError, SaysWhenOneLineDoesNotDetermineTwoModes) {
  Signal input;
  for (int i = 0; i < 2000; ++i)
    input.push_back(std::sin(2. * std::numbers::pi * 20. * i / rate_hz));
  const Bvrm truth = test::sensor(2, -2e-7);
  Signal output = simulate(truth, input, rate_hz);
  // Long after the start, when no free response is left.
  input.erase(input.begin(), input.begin() + 1500);
  output.erase(output.begin(), output.begin() + 1500);
  const Segment segment{input, output};
  EXPECT_EQ(refine_output_error(disturbed(truth), std::span(&segment, 1), rate_hz,
                                {.nuisance = {.initial_state = true, .offset = false}})
                .end,
            FitEnd::poor_excitation);
}

TEST(OutputError, RefusesWhatItCannotFit) {
  const Signal input = test::white_noise(100, 3., 12), output(100, 0.5);
  const Bvrm model = test::sensor(2);
  const auto fit = [&](const Bvrm& start, const Signal& u, const Signal& y, double rate = rate_hz) {
    const Segment segment{u, y};
    return refine_output_error(start, std::span(&segment, 1), rate);
  };
  EXPECT_THAT([&] { fit(model, input, Signal(99, 0.)); },
              ThrowsMessage<UserError>(HasSubstr("segment 1 has 100 samples")));
  EXPECT_THAT([&] { fit(model, Signal(20, 1.), Signal(20, 1.)); },
              ThrowsMessage<UserError>(HasSubstr("20 samples are too few for 14 unknowns")));
  EXPECT_THAT([&] { fit(model, input, output, 300.); },
              ThrowsMessage<UserError>(HasSubstr("a mode at 172")));
  EXPECT_THAT([&] { fit(model, input, output, -1.); },
              ThrowsMessage<UserError>(HasSubstr("rate -1")));
  Signal bad = output;
  bad[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { fit(model, input, bad); },
              ThrowsMessage<UserError>(HasSubstr("sample 7 of the base moment is not finite")));
  Bvrm unstable = model;
  unstable.modes[1].a1 = -1.;
  EXPECT_THAT([&] { fit(unstable, input, output); }, ThrowsMessage<UserError>(HasSubstr("mode 2")));
}

}  // namespace
}  // namespace vibrissa::separation
