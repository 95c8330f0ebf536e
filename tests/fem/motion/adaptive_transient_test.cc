#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include <algorithm>
#include <cmath>

#include "fem/motion/nonlinear_transient.h"
#include "signals/base/error.h"
#include "tests/fem/samples.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

class AdaptiveTransient : public testing::Test {
 protected:
  struct Motion {
    TransientOutput output;
    std::vector<Vector> displacements;  // at the samples
    double largest_m = 0.;
    std::vector<unsigned int> substeps;
  };
  Motion move(const double sampling_rate_hz, const std::vector<double>& a,
              NonlinearOptions options) const {
    Motion motion;
    options.check_balance = false;
    motion.output = simulate_nonlinear(sensor, {sampling_rate_hz, a.size(), a, {}, {}}, options,
                                       [&](std::size_t, const SolidState& state) {
                                         motion.displacements.push_back(state.displacement);
                                         motion.largest_m = std::max(
                                             motion.largest_m, state.displacement.linfty_norm());
                                       });
    for (const IntervalSteps& interval : motion.output.intervals)
      motion.substeps.push_back(interval.substeps);
    return motion;
  }
  static NonlinearOptions adaptive(const double tolerance, const double least_displacement_m,
                                   const unsigned int most) {
    return {.adaptive = SubstepOptions{tolerance, least_displacement_m, most}};
  }

  /// Near the first resonance, from rest to rest, to about 2 mm.
  static constexpr double swing_rate_hz = 500.;
  static std::vector<double> swing() {
    std::vector<double> a(20);
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double t = static_cast<double>(i) / swing_rate_hz;
      a[i] = 20. * std::sin(2. * M_PI * 27. * t) *
             std::pow(std::sin(M_PI * static_cast<double>(i) / 20.), 2);
    }
    return a;
  }
  /// Slow and weak.
  static std::vector<double> calm(const std::size_t n) {
    std::vector<double> a(n);
    for (std::size_t i = 0; i < n; ++i)
      a[i] = std::pow(std::sin(2. * M_PI * 4. * static_cast<double>(i) / rate_hz), 2);
    return a;
  }

  const Sensor sensor{whisker_sensor(1)};
};

TEST_F(AdaptiveTransient, TheErrorFallsWithTheToleranceAndStaysBelowIt) {
  const Motion reference = move(swing_rate_hz, swing(), {.substeps = 32});
  const auto error = [&](const double tolerance) {
    const Motion motion = move(swing_rate_hz, swing(), adaptive(tolerance, 1e-5, 64));
    double largest = 0.;
    for (std::size_t i = 0; i < motion.displacements.size(); ++i) {
      Vector difference(motion.displacements[i]);
      difference -= reference.displacements[i];
      largest = std::max(largest, difference.linfty_norm());
    }
    EXPECT_EQ(summarise(motion.output.intervals, tolerance).n_over_tolerance, 0u);
    return largest / reference.largest_m;
  };
  const double loose = error(1e-2), tight = error(1e-3);
  EXPECT_LT(loose, 1e-2);
  EXPECT_LT(tight, 1e-3);
  EXPECT_GT(loose, 4. * tight);
  EXPECT_GT(tight, 1e-3 / 20.) << "more substeps than are asked for";
}

TEST_F(AdaptiveTransient, ACalmRecordTakesOneSubstepAndIsThatOfFixedOnesBitForBit) {
  const auto a = calm(40);
  const Motion chosen = move(rate_hz, a, adaptive(5e-3, 1e-3, 64)), fixed = move(rate_hz, a, {});
  EXPECT_THAT(chosen.substeps, AllOf(testing::SizeIs(39), Each(1u)));
  EXPECT_EQ(chosen.output.base_moment, fixed.output.base_moment);
  EXPECT_EQ(chosen.output.cross_moment, fixed.output.cross_moment);
  EXPECT_EQ(chosen.output.count.n_iterations, fixed.output.count.n_iterations);
  EXPECT_EQ(chosen.output.energy.back().work_j, fixed.output.energy.back().work_j);
  EXPECT_TRUE(fixed.output.intervals.empty());
}

TEST_F(AdaptiveTransient, ASuddenBurstTakesMoreSubstepsThereAlone) {
  constexpr std::size_t first = 15, length = 6, ringing = 20;
  auto a = calm(60);
  for (std::size_t i = 0; i < length; ++i)
    a[first + i] += 500. * std::pow(std::sin(M_PI * static_cast<double>(i) / length), 2);
  const Motion motion = move(rate_hz, a, adaptive(6e-3, 1e-3, 64));
  for (std::size_t i = 0; i < motion.substeps.size(); ++i) {
    const bool is_within = i > first && i < first + length;
    const bool is_away = i < first || i > first + length + ringing;
    if (is_within) {
      EXPECT_GE(motion.substeps[i], 4u) << i;
    } else if (is_away) {
      EXPECT_EQ(motion.substeps[i], 1u) << i;
    }
  }
  const SubstepSummary summary = summarise(motion.output.intervals, 6e-3);
  EXPECT_EQ(summary.smallest, 1u);
  EXPECT_GE(summary.n_rejected, 1u);
}

TEST_F(AdaptiveTransient, AChangeOfTheStepKeepsTheEnergyBalanceClosed) {
  const Motion motion = move(swing_rate_hz, swing(), adaptive(1e-3, 1e-5, 64));
  double work = 0., error = 0.;
  for (const auto& energy : motion.output.energy) {
    work = std::max(work, std::abs(energy.work_j));
    error = std::max(error, std::abs(energy.error_j(motion.output.energy.front())));
  }
  EXPECT_LT(error, 1e-6 * work);
}

// A jolt of 1500 times the weight within 4 ms.
TEST_F(AdaptiveTransient, ALoadThatIsTooMuchForOneStepIsTakenInParts) {
  const std::vector<double> jolt{0., 15e3};
  constexpr double any_error = 1e3;
  const auto refusal_of = [&](const NonlinearOptions& options) {
    try {
      move(250., jolt, options);
    } catch (const signals::UserError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  constexpr const char* advice = "Substep choice = adaptive";
  EXPECT_THAT(refusal_of({}), AllOf(HasSubstr("in step 1, at 0.004 s"), HasSubstr(advice)));
  EXPECT_THAT(refusal_of(adaptive(any_error, 1., 1)),
              AllOf(HasSubstr("in step 1, at 0.004 s"), Not(HasSubstr(advice))));
  const Motion motion = move(250., jolt, adaptive(any_error, 1., 64));
  EXPECT_EQ(motion.output.intervals.front().n_rejected, 1u);
  EXPECT_EQ(motion.substeps.front(), 2u);
}

}  // namespace
}  // namespace vibrissa::fem
