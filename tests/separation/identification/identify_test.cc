#include "separation/identification/identify.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"
#include "tests/separation/moment_record.h"

namespace vibrissa::separation {
namespace {

using signals::Record;
using signals::UserError;
using test::make_record;
using test::Signal;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;
namespace channel = signals::channel;

using test::rate_hz;

Record held_record(const Bvrm& model, std::size_t n, std::uint64_t seed, double noise = 0.,
                   Hold hold = Hold::first_order) {
  Signal input = test::white_noise(n, 3., seed);
  Signal output = test::plus_noise(simulate(model, input, rate_hz, hold), noise, seed + 1000);
  return make_record(std::move(input), std::move(output));
}

// Lines in steady state, as a shaker with a smooth drive gives them.
Record smooth_record(const Bvrm& model, std::size_t n, std::uint64_t seed,
                     std::size_t period_samples = 0) {
  test::Lines lines(1.5, 200., 150, seed);
  if (period_samples > 0) {
    const double resolution_hz = rate_hz / static_cast<double>(period_samples);
    for (double& f : lines.frequency_hz) f = resolution_hz * std::round(f / resolution_hz);
  }
  return make_record(lines.sample(n, rate_hz), lines.answer(model, n, rate_hz));
}

TEST(HoldOutLastThird, CutsEverySampleOnceAndOnWholePeriodsWhenAsked) {
  const Record record = make_record(test::white_noise(1000, 1., 1), test::white_noise(1000, 1., 2));
  for (const auto& [multiple, n_fit] : {std::pair(1u, 666u), std::pair(250u, 500u)}) {
    const auto [fit, held_out] = hold_out_last_third(record, multiple);
    EXPECT_EQ(fit.n_samples(), n_fit);
    ASSERT_EQ(fit.n_samples() + held_out.n_samples(), record.n_samples());
    EXPECT_EQ(fit.channel(channel::base_moment)[n_fit - 1],
              record.channel(channel::base_moment)[n_fit - 1]);
    EXPECT_EQ(held_out.channel(channel::base_moment)[0],
              record.channel(channel::base_moment)[n_fit]);
  }
}

TEST(Identify, RecoversCleanModalModelsOfOneToThreeModesAndTheirOrder) {
  for (std::size_t n_modes = 1; n_modes <= 3; ++n_modes) {
    Bvrm truth = test::sensor(n_modes, -2e-7);
    std::ranges::sort(truth.modes, {}, &ModalTerm::a0);
    const Identification found =
        identify_bvrm(held_record(truth, 6000, 1), held_record(truth, 3000, 2));
    EXPECT_EQ(found.order, 2 * n_modes);
    EXPECT_EQ(found.hold, Hold::first_order);
    EXPECT_EQ(found.fit.end, FitEnd::converged);
    EXPECT_GT(found.held_out_fit_percent, 99.9999);
    for (std::size_t k = 0; k < found.fit.model.modes.size(); ++k) {
      EXPECT_NEAR(found.fit.model.modes[k].frequency_hz() / truth.modes[k].frequency_hz(), 1.,
                  1e-7);
      EXPECT_NEAR(found.fit.model.modes[k].damping_ratio() / truth.modes[k].damping_ratio(), 1.,
                  1e-5);
      EXPECT_NEAR(found.fit.model.modes[k].b0 / truth.modes[k].b0, 1., 1e-5) << "phase and gain";
    }
  }
}

TEST(Identify, TellsASmoothDriveFromStraightLinesAndFitsIt) {
  const Bvrm truth = test::sensor(2, -2e-7);
  for (const std::size_t period_samples : {0u, 1000u}) {
    IdentifyOptions options;
    options.period_samples = period_samples;
    const Identification found = identify_bvrm(smooth_record(truth, 6000, 3, period_samples),
                                               smooth_record(truth, 3000, 4), options);
    EXPECT_EQ(found.hold, Hold::band_limited);
    EXPECT_GT(found.held_out_fit_percent, 99.9);
    EXPECT_NEAR(found.fit.modes[0].frequency_hz.value, 31.47, 1e-3);
    EXPECT_NEAR(found.fit.modes[1].frequency_hz.value, 172., 0.02);
  }
}

TEST(Identify, GivesTheSensorByEveryMethodOnPeriodsWithNoise) {
  const Bvrm truth = test::sensor(2, -2e-7);
  const auto noisy = [&](std::size_t n, std::uint64_t seed) {
    const Record clean = smooth_record(truth, n, seed, 1000);
    const auto input = clean.channel(channel::base_acceleration);
    const auto output = clean.channel(channel::base_moment);
    return make_record(
        {input.begin(), input.end()},
        test::plus_noise({output.begin(), output.end()}, 0.02 * test::rms(output), seed + 100));
  };
  const Record fit = noisy(6000, 3), held_out = noisy(3000, 4);
  std::vector<Estimate> first_hz;
  for (const IdentifyMethod method :
       {IdentifyMethod::output_error, IdentifyMethod::srivc, IdentifyMethod::frequency}) {
    const Identification found = identify_bvrm(
        fit, held_out,
        {.method = method, .order = 4, .period_samples = 1000, .hold = Hold::band_limited});
    EXPECT_EQ(found.fit.end, FitEnd::converged) << to_string(method);
    EXPECT_GT(found.held_out_fit_percent, 97.) << to_string(method);
    ASSERT_EQ(found.fit.modes.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      const Estimate& f = found.fit.modes[k].frequency_hz;
      EXPECT_NEAR(f.value, truth.modes[k].frequency_hz(), 4. * f.standard_deviation)
          << to_string(method);
    }
    first_hz.push_back(found.fit.modes[0].frequency_hz);
  }
  const auto moved = [&](std::size_t i) {
    return std::abs(first_hz[i].value - first_hz[0].value) / first_hz[0].standard_deviation;
  };
  EXPECT_GT(moved(1), 0.01) << "SRIVC keeps the unknowns that the output error leaves out";
  EXPECT_GT(moved(2), 0.01) << "the scatter between periods weighs the lines";
}

TEST(Identify, KnowsItsMethodsByName) {
  for (const std::string name : {"output-error", "srivc", "frequency"})
    EXPECT_EQ(to_string(parse_identify_method(name)), name);
  EXPECT_THAT([] { parse_identify_method("arx"); },
              ThrowsMessage<UserError>(HasSubstr("output-error, srivc, frequency")));
}

// Noise of the accelerometer is carried through the model by whoever identifies it.
TEST(Identify, ChoosesTheOrderInTheNoiseOfAnAccelerometer) {
  const Bvrm truth = test::sensor(2, -2e-7);
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    Record fit = held_record(truth, 8000, seed, 1e-7);
    const auto motion = fit.channel(channel::base_acceleration);
    fit.set_channel(channel::base_acceleration,
                    test::plus_noise({motion.begin(), motion.end()}, 0.3, 50 + seed));
    for (const OrderRule rule : {OrderRule::information, OrderRule::cross_validation}) {
      const Identification found =
          identify_bvrm(fit, held_record(truth, 3000, 10 + seed), {.order_rule = rule});
      EXPECT_EQ(found.order, 4u) << seed << ": " << found.order_words;
    }
  }
}

TEST(Identify, SeesAModeAboveTheBandAsADirectTerm) {
  Bvrm truth;
  truth.modes = {make_modal_term(27.2, 0.05, -9e-6, -3e-9), make_modal_term(172., 0.05, -8e-7),
                 make_modal_term(466., 0.05, -1e-7)};
  IdentifyOptions options;
  options.order = 4;
  options.hold = Hold::band_limited;
  const Identification found =
      identify_bvrm(smooth_record(truth, 6000, 5), smooth_record(truth, 3000, 6), options);
  EXPECT_GT(found.held_out_fit_percent, 99.9);
  EXPECT_NEAR(found.fit.direct_term_kg_m.value, -1e-7, 2e-8);
  EXPECT_LT(found.fit.direct_term_kg_m.standard_deviation, 2e-9);
}

TEST(Identify, CountsTheModesUnderNoise) {
  const Bvrm truth = test::sensor(2, -2e-7);
  const double noise = 1e-6;
  const Identification found =
      identify_bvrm(held_record(truth, 8000, 7, noise), held_record(truth, 4000, 8, noise));
  EXPECT_EQ(found.order, 4u);
  for (std::size_t k = 0; k < 2; ++k) {
    const ModeEstimate& mode = found.fit.modes[k];
    const ModalTerm& true_mode = truth.modes[k];
    EXPECT_LT(std::abs(mode.frequency_hz.value - true_mode.frequency_hz()),
              4. * mode.frequency_hz.standard_deviation);
    EXPECT_LT(std::abs(mode.damping_ratio.value - true_mode.damping_ratio()),
              4. * mode.damping_ratio.standard_deviation);
  }
  EXPECT_LT(std::abs(found.fit.direct_term_kg_m.value - -2e-7),
            4. * found.fit.direct_term_kg_m.standard_deviation);
  EXPECT_NEAR(std::sqrt(found.fit.residual_variance), noise, 0.03 * noise);
}

TEST(Identify, LeavesTheDirectTermOutWhenToldSo) {
  IdentifyOptions options;
  options.direct_term = false;
  options.order = 2;
  const Bvrm truth = test::sensor(1);
  const Identification found =
      identify_bvrm(held_record(truth, 3000, 9), held_record(truth, 3000, 10), options);
  EXPECT_EQ(found.fit.model.direct_term_kg_m, 0.);
  EXPECT_EQ(found.fit.covariance.rows(), 4);
  EXPECT_GT(found.held_out_fit_percent, 99.9999);
}

TEST(Identify, UsesAKnownDelay) {
  Bvrm truth = test::sensor(1, -2e-7);
  truth.delay_s = 0.0027;
  IdentifyOptions options;
  options.delay_s = 0.0027;
  const Identification found =
      identify_bvrm(held_record(truth, 4000, 11), held_record(truth, 3000, 12), options);
  EXPECT_GT(found.held_out_fit_percent, 99.9999);
  EXPECT_EQ(found.fit.model.delay_s, 0.0027);
}

TEST(Identify, FitsSeveralRecordsTogether) {
  const Bvrm truth = test::sensor(1, -2e-7);
  const std::vector<Record> records{held_record(truth, 3000, 13, 1e-6),
                                    held_record(truth, 3000, 14, 1e-6)};
  const Record held_out = held_record(truth, 3000, 15, 1e-6);
  const Identification both = identify_bvrm(records, held_out);
  const Identification one = identify_bvrm(records[0], held_out);
  EXPECT_NEAR(both.fit.modes[0].frequency_hz.standard_deviation /
                  one.fit.modes[0].frequency_hz.standard_deviation,
              std::sqrt(0.5), 0.05);
}

// The last of the held-out record is another sensor: the fit must not know.
TEST(Identify, NeverLearnsFromTheHeldOutRecord) {
  const Bvrm truth = test::sensor(1, -2e-7), other = test::sensor(2);
  const Record fit = held_record(truth, 3000, 16, 1e-6);
  const Identification honest = identify_bvrm(fit, held_record(truth, 3000, 17, 1e-6));
  const Identification fooled = identify_bvrm(fit, held_record(other, 3000, 17, 1e-6));
  EXPECT_EQ(honest.order, fooled.order);
  EXPECT_EQ(honest.fit.model.modes[0].a0, fooled.fit.model.modes[0].a0);
  EXPECT_GT(honest.held_out_fit_percent, fooled.held_out_fit_percent);
}

TEST(Identify, IsRepeatable) {
  const Bvrm truth = test::sensor(2);
  const Record fit = held_record(truth, 3000, 18, 1e-6), held_out = held_record(truth, 3000, 19);
  const Identification first = identify_bvrm(fit, held_out), second = identify_bvrm(fit, held_out);
  EXPECT_EQ(first.fit.model.modes[0].a1, second.fit.model.modes[0].a1);
  EXPECT_EQ(first.held_out_fit_percent, second.held_out_fit_percent);
}

TEST(Identify, RefusesRecordsThatTellNothing) {
  const Bvrm truth = test::sensor(1);
  const Record good = held_record(truth, 3000, 20);
  const auto refuse = [&](const Record& fit, const Record& held_out, const std::string& message,
                          const IdentifyOptions& options = {}) {
    EXPECT_THAT([&] { identify_bvrm(fit, held_out, options); },
                ThrowsMessage<UserError>(HasSubstr(message)));
  };
  Record no_moment(rate_hz, 3000);
  no_moment.set_channel(channel::base_acceleration, test::white_noise(3000, 1., 1));
  refuse(no_moment, good, "base_moment");
  refuse(good, no_moment, "base_moment");
  refuse(make_record(Signal(3000, 1.), test::white_noise(3000, 1., 1)), good,
         "base_acceleration_m_s2 of the fit record 1 is constant");
  refuse(make_record(test::white_noise(3000, 1., 1), Signal(3000, 0.)), good,
         "base_moment_N_m of the fit record 1 is constant");
  refuse(good, make_record(test::white_noise(3000, 1., 1), test::white_noise(3000, 1., 2), 400.),
         "held-out record has a sampling rate of 400");
  Signal bad = test::white_noise(3000, 1., 1);
  bad[1500] = std::numeric_limits<double>::quiet_NaN();
  refuse(make_record(bad, test::white_noise(3000, 1., 1)), good, "at sample 1500 (3");
  refuse(held_record(truth, 40, 1), good, "too few for a model of order 6", {.order = 6});
  refuse(held_record(truth, 20, 1), good, "too few for a model of order 2");
  refuse(good, good, "order = 3", {.order = 3});
  refuse(good, good, "order = 0", {.max_order = 0});
  refuse(good, good, "contain no whole period of 4000", {.period_samples = 4000});
}

TEST(Identify, SaysWhenTheLinesAreTooFewForTheOrder) {
  test::Lines two(20., 30., 2, 21);
  for (double& f : two.frequency_hz) f = std::round(f);
  const Bvrm truth = test::sensor(1);
  const Record record = make_record(two.sample(2000, rate_hz), two.answer(truth, 2000, rate_hz));
  IdentifyOptions options;
  options.period_samples = 500;
  EXPECT_THAT([&] { identify_bvrm(record, record, options); },
              ThrowsMessage<UserError>(HasSubstr("lines")));
}

}  // namespace
}  // namespace vibrissa::separation
