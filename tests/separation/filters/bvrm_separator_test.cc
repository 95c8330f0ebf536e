#include "separation/filters/bvrm_separator.h"

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

using test::rate_hz;

Record record_of(const Signal& a, const Signal& m) {
  Record record(rate_hz, a.size());
  record.set_channel(signals::channel::base_acceleration, a);
  record.set_channel(signals::channel::base_moment, m);
  return record;
}

TEST(BvrmSeparator, LeavesExactlyTheWindWhenItsModelIsTrue) {
  const Signal a = test::white_noise(1200, 3., 1), wind = test::white_noise(1200, 1e-5, 2);
  for (const Hold hold : {Hold::first_order, Hold::zero_order})
    for (const double delay_s : {0., 0.004, 0.0027, -0.0033}) {
      Bvrm model = test::sensor(2, -2e-7);
      model.delay_s = delay_s;
      Signal m = simulate(model, a, rate_hz, hold);
      const double size = test::rms(m);
      for (std::size_t i = 0; i < m.size(); ++i) m[i] += wind[i];
      BvrmSeparator separator(model, rate_hz, hold);
      const Signal found = separate_record(separator, record_of(a, m));
      EXPECT_LT(test::rms(test::minus(found, wind)), 1e-13 * size) << delay_s;
    }
}

TEST(BvrmSeparator, NeedsNoLatencyForStraightLines) {
  EXPECT_EQ(BvrmSeparator(test::sensor(2), rate_hz).latency_samples(), 0u);
  EXPECT_EQ(BvrmSeparator(test::sensor(2), rate_hz, Hold::band_limited).latency_samples(),
            InputShaper::half_length);
}

TEST(BvrmSeparator, RemovesABandLimitedVibrationButForItsStart) {
  const test::Lines lines(2., 210., 40, 3);
  for (const double delay_s : {0., 0.0027, -0.0053, 0.09}) {
    Bvrm model = test::sensor(2, -2e-7);
    model.delay_s = delay_s;
    const std::size_t n = 3000;
    const Signal m = lines.answer(model, n, rate_hz);
    BvrmSeparator separator(model, rate_hz, Hold::band_limited);
    const Signal found = separate_record(separator, record_of(lines.sample(n, rate_hz), m));
    // Ring-down of the first mode: exp(-0.027 * 2 pi 31.47 * 4 s) < 1e-9.
    EXPECT_LT(test::rms(std::span(found).subspan(2000, 900)), 1e-3 * test::rms(m)) << delay_s;
  }
}

TEST(BvrmSeparator, GivesTheSameWhateverTheChunks) {
  const Signal a = test::white_noise(1000, 3., 4), m = test::white_noise(1000, 1e-5, 5);
  for (const Hold hold : {Hold::first_order, Hold::band_limited})
    for (const double delay_s : {0.0113, -0.0033}) {
      Bvrm model = test::sensor(2, -2e-7);
      model.delay_s = delay_s;
      BvrmSeparator separator(model, rate_hz, hold);
      Signal whole(a.size()), parts(a.size());
      separator.process(a, m, whole);
      separator.reset();
      std::mt19937 random(6);
      for (std::size_t done = 0; done < a.size();) {
        const std::size_t chunk = std::min<std::size_t>(random() % 70, a.size() - done);
        separator.process(std::span(a).subspan(done, chunk), std::span(m).subspan(done, chunk),
                          std::span(parts).subspan(done, chunk));
        done += chunk;
      }
      EXPECT_LT(test::rms(test::minus(whole, parts)), 1e-14 * test::rms(whole));
      for (std::size_t i = 0; i < separator.latency_samples(); ++i) EXPECT_EQ(whole[i], 0.);
    }
}

TEST(BvrmSeparator, RefusesABadModelOrRate) {
  EXPECT_THAT([] { BvrmSeparator(test::sensor(1), 0.); },
              ThrowsMessage<UserError>(HasSubstr("sampling rate 0")));
  Bvrm model = test::sensor(1);
  model.modes[0].a1 = -1.;
  EXPECT_THAT([&] { BvrmSeparator(model, rate_hz); },
              ThrowsMessage<UserError>(HasSubstr("mode 1")));
}

}  // namespace
}  // namespace vibrissa::separation
