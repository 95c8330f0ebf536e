#include "separation/filters/fdaf.h"

#include <gmock/gmock.h>

#include "separation/model/simulation.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::Record;
using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

Record record_of_path(const Signal& a, const Signal& m) {
  Record record(500., a.size());
  record.set_channel(signals::channel::base_acceleration, a);
  record.set_channel(signals::channel::base_moment, m);
  return record;
}

Signal convolve(const Signal& taps, const Signal& x) {
  Signal y(x.size(), 0.);
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t tap = 0; tap < taps.size() && tap <= i; ++tap) y[i] += taps[tap] * x[i - tap];
  return y;
}

/// The oracle: block LMS in the time domain. Taps stand still over a block and then move by
/// mu sum_i e[i] x[i - tap].
Signal block_lms(const Signal& x, const Signal& d, std::size_t block, std::size_t n_taps, double mu,
                 double kept) {
  Signal taps(n_taps, 0.), errors(x.size(), 0.);
  for (std::size_t first = 0; first + block <= x.size(); first += block) {
    Signal gradient(n_taps, 0.);
    for (std::size_t i = first; i < first + block; ++i) {
      double y = 0.;
      for (std::size_t tap = 0; tap < n_taps && tap <= i; ++tap) y += taps[tap] * x[i - tap];
      errors[i] = d[i] - y;
      for (std::size_t tap = 0; tap < n_taps && tap <= i; ++tap)
        gradient[tap] += errors[i] * x[i - tap];
    }
    for (std::size_t tap = 0; tap < n_taps; ++tap)
      taps[tap] = kept * taps[tap] + mu * gradient[tap];
  }
  return errors;
}

TEST(Fdaf, EqualsBlockLmsWhenConstrainedWithAFixedStep) {
  const Signal x = test::white_noise(3000, 2., 1);
  const Signal d = test::plus_noise(convolve(test::white_noise(30, 0.3, 2), x), 0.1, 3);
  for (const std::size_t block : {1u, 8u, 20u, 25u})
    for (const double leakage : {0., 0.01}) {
      FdafOptions options;
      options.block_length = block;
      options.filter_length = 40;
      options.step = {.step = 2e-4, .normalisation = StepNormalisation::fixed};
      options.leakage = leakage;
      Fdaf fdaf(options);
      const Signal e = separate_record(fdaf, record_of_path(x, d));
      Signal twin = block_lms(x, d, block, fdaf.n_taps(), 2e-4, 1. - leakage);
      const std::size_t n = x.size() / block * block;
      for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(e[i], twin[i], 1e-9) << block << ", " << i;
    }
}

TEST(Fdaf, RoundsItsFilterUpToWholePartitions) {
  FdafOptions options;
  options.block_length = 64;
  options.filter_length = 400;
  const Fdaf fdaf(options);
  EXPECT_EQ(fdaf.n_partitions(), 7u);
  EXPECT_EQ(fdaf.n_taps(), 448u);
  EXPECT_EQ(fdaf.latency_samples(), 63u);
}

double relative_distance(const Signal& found, const Signal& truth) {
  Signal padded = truth;
  padded.resize(found.size(), 0.);
  return test::rms(test::minus(found, padded)) / test::rms(padded);
}

TEST(Fdaf, FindsDelaysAcrossTheBordersOfItsPartitions) {
  const std::size_t block = 16;
  for (const std::size_t delay :
       {std::size_t{0}, std::size_t{1}, block - 1, block, 3 * block + 7}) {
    Signal taps(delay + 5, 0.);
    for (std::size_t i = 0; i < 5; ++i) taps[delay + i] = std::pow(-0.6, i);
    const Signal x = test::white_noise(20000, 1., 4);
    FdafOptions options;
    options.block_length = block;
    options.filter_length = 5 * block;
    options.step.step = 1.;
    Fdaf fdaf(options);
    const Signal e = separate_record(fdaf, record_of_path(x, convolve(taps, x)));
    EXPECT_LT(relative_distance(fdaf.impulse_response(), taps), 1e-6) << delay;
    EXPECT_LT(test::rms(std::span(e).last(1000)), 1e-6) << delay;
  }
}

TEST(Fdaf, ConvergesToTheSensorsImpulseResponseUnderAColouredInput) {
  Signal x = test::white_noise(60000, 1., 5);
  for (std::size_t i = 1; i < x.size(); ++i) x[i] += 0.7 * x[i - 1];
  Bvrm model;
  model.modes = {make_modal_term(31.47, 0.1, 1.)};
  Signal impulse(200, 0.);
  impulse[0] = 1.;
  const Signal taps = simulate(model, impulse, 500., Hold::zero_order);
  for (const Constraint constraint : {Constraint::constrained, Constraint::alternating}) {
    FdafOptions options;
    options.block_length = 32;
    options.filter_length = 200;
    options.step.step = 0.5;
    options.constraint = constraint;
    Fdaf fdaf(options);
    separate_record(fdaf, record_of_path(x, convolve(taps, x)));
    EXPECT_LT(relative_distance(fdaf.impulse_response(), taps), 0.02);
  }
}

// The warning of the reference study's settings: with the power of one block and P partitions the
// step is P times too large.
TEST(Fdaf, IsStableForStepsUpToTwoWhateverTheNumberOfPartitions) {
  const Signal x = test::white_noise(30000, 1., 6);
  const Signal d = convolve(test::white_noise(160, 0.1, 7), x);
  for (const double step : {0.1, 1., 1.9})
    for (const std::size_t n_partitions : {1u, 2u, 20u})
      for (const Constraint constraint :
           {Constraint::constrained, Constraint::alternating, Constraint::unconstrained}) {
        FdafOptions options;
        options.block_length = 160 / n_partitions;
        options.filter_length = 160;
        options.step.step = step;
        options.constraint = constraint;
        Fdaf fdaf(options);
        const Signal e = separate_record(fdaf, record_of_path(x, d));
        EXPECT_LT(test::rms(std::span(e).last(2000)), 0.2 * test::rms(d))
            << step << ", " << n_partitions;
      }
}

TEST(Fdaf, IsUnchangedWhenBothInputsAreScaledByAMillionth) {
  const Signal x = test::white_noise(4000, 2., 8);
  const Signal d = test::plus_noise(convolve(test::white_noise(30, 0.3, 9), x), 0.1, 10);
  const auto scaled = [](Signal signal, double factor) {
    for (double& value : signal) value *= factor;
    return signal;
  };
  for (const double factor : {1e-6, 1e6}) {
    Fdaf plain(FdafOptions{}), small(FdafOptions{});
    const Signal e = separate_record(plain, record_of_path(x, d));
    const Signal e_scaled =
        separate_record(small, record_of_path(scaled(x, factor), scaled(d, factor)));
    EXPECT_LT(test::rms(test::minus(scaled(e_scaled, 1. / factor), e)), 1e-12 * test::rms(e));
  }
}

TEST(Fdaf, KeepsWhatItLearntThroughSilenceAndNearSilence) {
  const Signal taps = test::white_noise(30, 0.3, 11);
  Signal x = test::white_noise(30000, 2., 12);
  for (const double level : {0., 1e-12, 1e-5}) {
    Signal quiet = x;
    for (std::size_t i = 12000; i < 24000; ++i) quiet[i] *= level;
    // While the base rests the wind blows on: the error is large and has nothing to do with the
    // base.
    Signal d = convolve(taps, quiet);
    const Signal wind = test::white_noise(d.size(), 1., 13);
    for (std::size_t i = 12000; i < 24000; ++i) d[i] += wind[i];
    FdafOptions options;
    options.step.step = 0.5;
    options.filter_length = 60;
    Fdaf fdaf(options);
    const Signal e = separate_record(fdaf, record_of_path(quiet, d));
    EXPECT_THAT(e, testing::Each(testing::Truly([](double v) { return std::isfinite(v); })));
    const double vibration = test::rms(std::span(d).last(6000));
    EXPECT_LT(test::rms(std::span(e).subspan(10000, 2000)), 1e-3 * vibration) << level;
    EXPECT_LT(test::rms(std::span(e).subspan(24100, 300)), 0.05 * vibration)
        << "forgot in a silence of level " << level;
  }
}

TEST(Fdaf, PassesTheWindUnchangedWhenTheBaseDoesNotMove) {
  const Signal wind = test::white_noise(1000, 1., 14);
  Fdaf fdaf(FdafOptions{});
  EXPECT_EQ(separate_record(fdaf, record_of_path(Signal(1000, 0.), wind)), wind);
}

TEST(Fdaf, GivesTheSameAgainAfterAReset) {
  const Signal x = test::white_noise(2000, 2., 15), d = test::white_noise(2000, 2., 16);
  Fdaf fdaf(paper_simulation_fdaf());
  const Signal first = separate_record(fdaf, record_of_path(x, d));
  EXPECT_EQ(separate_record(fdaf, record_of_path(x, d)), first);
}

TEST(Fdaf, HoldsTheRingDownInThePapersSettings) {
  // 431 samples to 1 % at 31.47 Hz, zeta 0.027, 500 Hz (docs/theory.md, T15).
  const double decay = 0.027 * 2. * std::numbers::pi * 31.47;
  const double n_samples = std::log(100.) / decay * 500.;
  EXPECT_NEAR(n_samples, 431., 1.);
  for (const FdafOptions& options : {paper_simulation_fdaf(), paper_experiment_fdaf()})
    EXPECT_GE(static_cast<double>(Fdaf(options).n_taps()), n_samples);
  EXPECT_EQ(paper_simulation_fdaf().block_length, 20u);
  EXPECT_EQ(paper_simulation_fdaf().step.step, 0.1);
  EXPECT_EQ(paper_experiment_fdaf().block_length, 200u);
  EXPECT_EQ(paper_experiment_fdaf().step.step, 0.001);
}

TEST(Fdaf, RefusesOptionsOutOfRange) {
  const auto refuse = [](const std::function<void(FdafOptions&)>& spoil,
                         const std::string& message) {
    FdafOptions options;
    spoil(options);
    EXPECT_THAT([&] { Fdaf fdaf(options); }, ThrowsMessage<UserError>(HasSubstr(message)));
  };
  refuse([](FdafOptions& o) { o.block_length = 0; }, "block_length");
  refuse([](FdafOptions& o) { o.filter_length = 0; }, "filter_length");
  refuse([](FdafOptions& o) { o.leakage = 1.5; }, "leakage = 1.5");
  refuse([](FdafOptions& o) { o.step.step = 3.; }, "step = 3");
}

}  // namespace
}  // namespace vibrissa::separation
