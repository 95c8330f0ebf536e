#include <gmock/gmock.h>

#include <functional>
#include <memory>

#include "separation/filters/bvrm_separator.h"
#include "separation/filters/fdaf.h"
#include "separation/filters/kalman_filter.h"
#include "separation/filters/line_canceller.h"
#include "separation/filters/nlms.h"
#include "separation/filters/output_guard.h"
#include "separation/filters/rls.h"
#include "tests/separation/test_signals.h"
#include "tests/signals/peak.h"

namespace vibrissa::separation {
namespace {

using signals::test::peak;
using test::Signal;

using MakeSeparator = std::function<std::unique_ptr<Separator>()>;

FdafOptions with(Constraint constraint, PowerSmoothing smoothing = PowerSmoothing::guarded) {
  FdafOptions options;
  options.constraint = constraint;
  options.step.smoothing = smoothing;
  return options;
}

// All adaptive methods with their default settings.
const std::vector<MakeSeparator>& adaptive_methods() {
  static const std::vector<MakeSeparator> methods{
      [] { return std::make_unique<Fdaf>(FdafOptions{}); },
      [] { return std::make_unique<Fdaf>(with(Constraint::alternating)); },
      [] { return std::make_unique<Fdaf>(with(Constraint::unconstrained)); },
      [] { return std::make_unique<Fdaf>(with(Constraint::constrained, PowerSmoothing::mean)); },
      [] { return std::make_unique<Fdaf>(with(Constraint::constrained, PowerSmoothing::none)); },
      [] { return std::make_unique<PartitionedKalman>(KalmanOptions{}); },
      [] { return std::make_unique<Nlms>(NlmsOptions{}); },
      [] { return std::make_unique<Rls>(RlsOptions{}); },
      [] { return std::make_unique<LineCanceller>(LineCancellerOptions{}); }};
  return methods;
}

struct Pair {
  Signal acceleration, moment;
};

/// Damages either channel in a random way, in a random stretch of it.
class Vandal {
 public:
  explicit Vandal(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  std::size_t any(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }

  void damage(Signal& x) {
    const std::size_t first = any(x.size()), last = first + any(x.size() - first) + 1;
    const std::span part = std::span(x).subspan(first, last - first);
    const double level = test::rms(x);
    switch (any(7)) {
      case 0:
        std::ranges::fill(part, 0.);
        break;  // gap
      case 1:
        scale(part, std::pow(10., uniform(-15., -6.)));
        break;  // near-silence
      case 2:
        scale(part, std::pow(10., uniform(1., 6.)));
        break;  // burst
      case 3:
        add(part, [&](double) { return 30. * level; });
        break;  // offset
      case 4:
        add(part, [&](double share) { return 30. * level * share; });
        break;  // drift
      case 5:
        clip(part, 0.3 * level);
        break;
      default:
        std::ranges::fill(part, part[0]);  // a channel that hangs
    }
  }

  Pair scenario(std::size_t n) {
    Pair pair{.acceleration = excitation(n), .moment = {}};
    const std::size_t delay = any(30);
    const double pole = uniform(-0.9, 0.9);
    pair.moment.assign(n, 0.);
    for (std::size_t i = 1; i < n; ++i)
      pair.moment[i] = pole * pair.moment[i - 1] + (i < delay ? 0. : pair.acceleration[i - delay]);
    const double wind = std::pow(10., uniform(-3., 1.)) * test::rms(pair.moment);
    pair.moment = test::plus_noise(pair.moment, wind, random_());
    for (std::size_t k = any(4); k > 0; --k) damage(pair.acceleration);
    for (std::size_t k = any(4); k > 0; --k) damage(pair.moment);
    scale(pair.acceleration, std::pow(10., uniform(-9., 3.)));
    scale(pair.moment, std::pow(10., uniform(-9., 3.)));
    return pair;
  }

 private:
  static void scale(std::span<double> x, double factor) {
    for (double& value : x) value *= factor;
  }
  static void add(std::span<double> x, const std::function<double(double)>& what) {
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += what(static_cast<double>(i) / static_cast<double>(x.size()));
  }
  static void clip(std::span<double> x, double level) {
    for (double& value : x) value = std::clamp(value, -level, level);
  }
  Signal excitation(std::size_t n) {
    if (any(3) == 0) return test::Lines(3., 200., 1 + any(8) + 1, random_()).sample(n, 500.);
    Signal x = test::white_noise(n, 1., random_());
    const double memory = uniform(-0.5, 0.99);
    for (std::size_t i = 1; i < n; ++i) x[i] += memory * x[i - 1];
    return x;
  }

  std::mt19937_64 random_;
};

Signal run(const MakeSeparator& method, const Pair& pair, double factor = 1.) {
  Signal a = pair.acceleration, m = pair.moment, wind(m.size());
  for (double& value : a) value *= factor;
  for (double& value : m) value *= factor;
  method()->process(a, m, wind);
  for (double& value : wind) value /= factor;
  return wind;
}

constexpr double millionth = 0x1p-20;  // a power of two: scaling itself rounds nothing

class EachMethod : public testing::TestWithParam<std::size_t> {};

TEST_P(EachMethod, NeverExceedsFiveTimesTheLargestMomentInAThousandRandomScenarios) {
  const MakeSeparator& method = adaptive_methods()[GetParam()];
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Pair pair = Vandal(seed).scenario(1200);
    const double bound = (1. + OutputGuard::largest_share) * peak(pair.moment);
    const Signal wind = run(method, pair);
    for (std::size_t i = 0; i < wind.size(); ++i)
      ASSERT_TRUE(std::abs(wind[i]) <= bound)
          << method()->name() << ", scenario " << seed << ", sample " << i << ": " << wind[i];
  }
}

INSTANTIATE_TEST_SUITE_P(AdaptiveMethods, EachMethod,
                         testing::Range(std::size_t{0}, adaptive_methods().size()));

TEST(EveryMethod, IsUnchangedWhenBothInputsAreScaledByAMillionthInAnyScenario) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Pair pair = Vandal(seed).scenario(1200);
    const MakeSeparator& method = adaptive_methods()[seed % adaptive_methods().size()];
    const Signal wind = run(method, pair), small = run(method, pair, millionth);
    ASSERT_EQ(peak(test::minus(small, wind)), 0.) << method()->name() << ", scenario " << seed;
  }
}

TEST(EveryMethod, IsUnchangedToRoundingByAFactorOfTenToTheMinusSix) {
  const Pair pair = {.acceleration = test::white_noise(3000, 2., 1),
                     .moment = test::white_noise(3000, 3., 2)};
  for (const MakeSeparator& method : adaptive_methods()) {
    const Signal wind = run(method, pair), small = run(method, pair, 1e-6);
    EXPECT_LT(test::rms(test::minus(small, wind)), 1e-10 * test::rms(wind)) << method()->name();
  }
}

// A fixed model's bound is that of its gain: the peak of its answer to the worst input.
TEST(BvrmSeparator, NeverExceedsItsModelsGainInRandomScenarios) {
  const Bvrm model = test::sensor(3, -1e-7);
  Signal impulse(20000, 0.);
  impulse[0] = 1.;
  Signal nothing(impulse.size(), 0.), answer(impulse.size());
  BvrmSeparator separator(model, 500., Hold::zero_order);
  separator.process(impulse, nothing, answer);
  double gain = 0.;
  for (const double value : answer) gain += std::abs(value);
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Pair pair = Vandal(seed).scenario(1200);
    separator.reset();
    Signal wind(pair.moment.size());
    separator.process(pair.acceleration, pair.moment, wind);
    ASSERT_LE(peak(wind), 1.01 * gain * peak(pair.acceleration) + peak(pair.moment)) << seed;
  }
}

}  // namespace
}  // namespace vibrissa::separation
