// One record by the default options, against the Cramer-Rao bound of all its samples.
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "separation/identification/identify.h"
#include "separation/model/simulation.h"
#include "tests/separation/moment_record.h"

namespace vibrissa::separation {
namespace {

using test::rate_hz;
using test::Signal;

constexpr double resonance_hz = 31.47, damping = 0.027, gain_kg_m = -9e-6;

// A sensor of second order with three unknowns, its base acceleration held between the samples.
Signal moment_of_three(const Signal& input, const Eigen::Vector3d& unknowns, Hold hold) {
  return simulate({.modes = {make_modal_term(unknowns[0], unknowns[1], unknowns[2])}}, input,
                  rate_hz, hold);
}

// Standard deviations of frequency and damping ratio for noise of size one, from differences of the
// simulated moment.
Eigen::Vector3d bound_of_three(const Signal& input, Hold hold) {
  const Eigen::Vector3d at(resonance_hz, damping, gain_kg_m), step(1e-4, 1e-6, 1e-9);
  Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(input.size()), 3);
  for (Eigen::Index j = 0; j < 3; ++j) {
    const Eigen::Vector3d move = step[j] * Eigen::Vector3d::Unit(j);
    const Signal difference = test::minus(moment_of_three(input, at + move, hold),
                                          moment_of_three(input, at - move, hold));
    jacobian.col(j) =
        Eigen::Map<const Eigen::VectorXd>(difference.data(), jacobian.rows()) / (2. * step[j]);
  }
  const Eigen::Vector3d length = jacobian.colwise().norm();
  jacobian.array().rowwise() /= length.transpose().array();
  const Eigen::Matrix3d inverse = (jacobian.transpose() * jacobian).inverse();
  return inverse.diagonal().cwiseSqrt().cwiseQuotient(length);
}

struct DefaultScatter {
  std::array<double, 2> error_over_bound{}, covered{};  // frequency, damping ratio
  double right_hold = 0., right_order = 0.;             // shares of the draws
};

DefaultScatter draw_records(Hold hold, double snr_db, int n_draws) {
  DefaultScatter scatter;
  for (int i = 0; i < n_draws; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    const Signal input = test::white_noise(5000, 3., 2 * seed + 1);
    const Signal clean = moment_of_three(input, {resonance_hz, damping, gain_kg_m}, hold);
    const double noise = test::rms(clean) * std::pow(10., -snr_db / 20.);
    const Identification found =
        identify_record(test::make_record(input, test::plus_noise(clean, noise, 2 * seed + 2)));
    const Eigen::Vector3d bound = noise * bound_of_three(input, hold);
    scatter.right_hold += (found.hold == hold) / double(n_draws);
    scatter.right_order += (found.order == 2) / double(n_draws);
    // The mode with the largest gain, should there be several.
    const ModeEstimate& mode = *std::ranges::min_element(
        found.fit.modes, {},
        [](const ModeEstimate& m) { return std::abs(m.frequency_hz.value - resonance_hz); });
    const std::array estimates{mode.frequency_hz, mode.damping_ratio};
    const std::array truths{resonance_hz, damping};
    for (std::size_t j = 0; j < 2; ++j) {
      const double error = estimates[j].value - truths[j];
      scatter.error_over_bound[j] +=
          std::pow(error / bound[static_cast<Eigen::Index>(j)], 2) / n_draws;
      if (std::abs(error) <= 1.959964 * estimates[j].standard_deviation)
        scatter.covered[j] += 1. / n_draws;
    }
  }
  for (double& value : scatter.error_over_bound) value = std::sqrt(value);
  const std::string label = to_string(hold) + "_";
  testing::Test::RecordProperty(label + "frequency", std::to_string(scatter.error_over_bound[0]));
  testing::Test::RecordProperty(label + "damping", std::to_string(scatter.error_over_bound[1]));
  testing::Test::RecordProperty(label + "frequency_covered", std::to_string(scatter.covered[0]));
  testing::Test::RecordProperty(label + "damping_covered", std::to_string(scatter.covered[1]));
  testing::Test::RecordProperty(label + "right_hold", std::to_string(scatter.right_hold));
  testing::Test::RecordProperty(label + "right_order", std::to_string(scatter.right_order));
  return scatter;
}

TEST(IdentifyRecord, ComesNearTheCramerRaoBoundOfAllSamplesUnderEveryHold) {
  for (const Hold hold : {Hold::zero_order, Hold::first_order}) {
    const DefaultScatter scatter = draw_records(hold, 20., 30);
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_LT(scatter.error_over_bound[j], 1.5) << to_string(hold);
      EXPECT_GE(scatter.covered[j], 0.83) << to_string(hold);
    }
    EXPECT_GE(scatter.right_hold, 0.9) << to_string(hold);
  }
}

// Two recordings of a hammer hit, glued one after the other: the second begins with another moment.
signals::Record two_hits(const Bvrm& truth) {
  Signal force, moment;
  for (const double size : {3., 2.}) {
    Signal hit(4096, 0.);
    for (std::size_t i = 0; i < 5; ++i) hit[85 + i] = size * std::sin(0.5 * (1. + double(i)));
    const Signal answer = simulate(truth, hit, rate_hz);
    force.insert(force.end(), hit.begin(), hit.end());
    moment.insert(moment.end(), answer.begin(), answer.end());
  }
  const double noise = 0.01 * test::rms(moment);
  return test::make_record(test::plus_noise(force, 1e-3, 1), test::plus_noise(moment, noise, 2));
}

// What rings after a hit tells a mode that does not decay within the record, too.
TEST(IdentifyRecord, FindsAModeThatRingsLongerThanTheRecordOfAHit) {
  const Bvrm truth{
      .modes = {make_modal_term(21.2, 0.0006, 1e-3), make_modal_term(160., 0.003, 2e-4)}};
  const signals::Record record = two_hits(truth);
  const Identification found = identify_record(record);
  ASSERT_EQ(found.fit.modes.size(), 2u) << found.order_words;
  EXPECT_NEAR(found.fit.modes[0].frequency_hz.value, truth.modes[0].frequency_hz(), 0.01);
  EXPECT_NEAR(found.fit.modes[0].damping_ratio.value, 0.0006, 1e-4);
  EXPECT_GT(found.held_out_fit_percent, 90.);
}

TEST(IdentifyRecord, TakesEachHitOfAHammerForItself) {
  const Bvrm truth{
      .modes = {make_modal_term(21.2, 0.004, 1e-3), make_modal_term(160., 0.003, 2e-4)}};
  const Identification found = identify_record(two_hits(truth));
  EXPECT_EQ(found.n_hits, 2u);
  ASSERT_EQ(found.fit.modes.size(), 2u) << found.order_words;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(found.fit.modes[k].frequency_hz.value, truth.modes[k].frequency_hz(), 0.02);
    EXPECT_NEAR(found.fit.modes[k].damping_ratio.value, truth.modes[k].damping_ratio(), 3e-4);
  }
  EXPECT_GT(found.held_out_fit_percent, 95.) << "the second hit, with a start of its own";
}

// The share of 1000 draws scatters by 0.7 %.
TEST(IdentifyRecord, LongRunStatesIntervalsThatHoldTheTruthAsOftenAsTheySay) {
  const DefaultScatter scatter = draw_records(Hold::zero_order, 20., 1000);
  for (std::size_t j = 0; j < 2; ++j) {
    EXPECT_LT(scatter.error_over_bound[j], 1.5);
    EXPECT_GE(scatter.covered[j], 0.93);
    EXPECT_LE(scatter.covered[j], 0.97);
  }
}

}  // namespace
}  // namespace vibrissa::separation
