#include "separation/not_louder.h"

#include <gtest/gtest.h>

#include "separation/filters/fdaf.h"
#include "separation/model/simulation.h"
#include "tests/separation/moment_record.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

std::unique_ptr<Separator> adaptive() {
  return std::make_unique<Fdaf>(FdafOptions{64, 512, {}, {}, 0.});
}

// A loud stretch, then the accelerometer hums by itself (a motor beside it) while the moment is at
// rest.
struct LoudThenQuiet {
  Signal acceleration = test::white_noise(8000, 3., 1), moment;
  std::size_t quiet = 6000;

  LoudThenQuiet() : moment(simulate(test::sensor(1), acceleration, test::rate_hz)) {
    const Signal noise = test::white_noise(8000, 0.01 * test::rms(moment), 2);
    for (std::size_t i = 0; i < moment.size(); ++i)
      moment[i] = (i < quiet ? moment[i] : 0.) + noise[i];
  }
  signals::Record record() const { return test::make_record(acceleration, moment); }
  std::span<const double> in_quiet(const Signal& x) const {
    return std::span(x).subspan(quiet + 600);
  }
};

TEST(NotLouder, LeavesAQuietStretchAsQuietAsItWas) {
  const LoudThenQuiet signals;
  const auto plain = adaptive();
  NotLouder calm(adaptive(), 512);
  const double before = test::rms(signals.in_quiet(signals.moment));
  EXPECT_GT(test::rms(signals.in_quiet(separate_record(*plain, signals.record()))), 1.5 * before);
  EXPECT_LT(test::rms(signals.in_quiet(separate_record(calm, signals.record()))), 1.1 * before);
}

TEST(NotLouder, ChangesNothingWhereTheVibrationIsRemoved) {
  const Signal acceleration = test::white_noise(8000, 3., 3);
  const Signal vibration = simulate(test::sensor(1), acceleration, test::rate_hz);
  Signal moment = test::plus_noise(vibration, 0.3 * test::rms(vibration), 4);
  const signals::Record record = test::make_record(acceleration, moment);
  const auto plain = adaptive();
  NotLouder calm(adaptive(), 512);
  const Signal expected = separate_record(*plain, record), found = separate_record(calm, record);
  for (std::size_t i = 2000; i < found.size(); ++i) ASSERT_EQ(found[i], expected[i]) << i;
  EXPECT_EQ(separate_record(calm, record), found) << "reset";
  EXPECT_EQ(calm.latency_samples(), plain->latency_samples());
}

}  // namespace
}  // namespace vibrissa::separation
