#include "signals/files/joined_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

double motion(const double t) {
  return std::sin(2. * std::numbers::pi * 31. * t) +
         0.5 * std::cos(2. * std::numbers::pi * 90. * t);
}

std::string table(const std::string& name, const double rate_hz, const double start_s,
                  const double duration_s) {
  std::string text = "t," + name + "\n";
  for (int i = 0; i < int(duration_s * rate_hz); ++i) {
    const double t = start_s + i / rate_hz;
    text += to_text(t) + "," + to_text(motion(t)) + "\n";
  }
  return text;
}

class Joined : public ::testing::Test {
 protected:
  Recording read(const std::string& file, const std::string& text, const std::string& choice) {
    return read_recording(folder_.file(file, text), {.columns = {parse_column_choice(choice)}});
  }
  test::TemporaryFolder folder_;
};

TEST_F(Joined, TakesBothDevicesAtTheTimesOfTheSlowerOne) {
  for (const double late_s : {0., 0.3333}) {
    const Recording slow = read("m.csv", table("m", 500., 0., 4.), "base_moment=m");
    const Recording fast = read("a.csv", table("ax", 1600., late_s, 4.), "base_acceleration=ax");
    const Recording both = joined(fast, slow);
    const Record& record = both.pieces.front();
    EXPECT_EQ(record.sampling_rate_hz(), 500.);
    const auto a = record.channel(channel::base_acceleration);
    const auto m = record.channel(channel::base_moment);
    for (std::size_t i = 0; i < record.n_samples(); ++i) {
      ASSERT_NEAR(m[i], motion(record.time_s(i)), 2e-3);
      ASSERT_NEAR(a[i], m[i], 2e-3) << i;
    }
    EXPECT_GT(record.n_samples(), 1700u);
  }
}

TEST_F(Joined, FollowsADeviceThatRunsFast) {
  // The stamps of one device are true; its rate is odd.
  const Recording slow = read("m.csv", table("m", 487.31, 0., 4.), "base_moment=m");
  const Recording fast = read("a.csv", table("ax", 501.7, 0.01, 4.), "base_acceleration=ax");
  const Record record = joined(slow, fast).pieces.front();
  const auto a = record.channel(channel::base_acceleration);
  const auto m = record.channel(channel::base_moment);
  for (std::size_t i = 0; i < record.n_samples(); ++i) ASSERT_NEAR(a[i], m[i], 5e-3) << i;
}

// Near the highest frequency of the slower device, too, both channels show the same motion: a
// response between them gets no resonance from the filter.
TEST_F(Joined, FiltersBothDevicesAlike) {
  const auto near_the_edge = [](const std::string& name, const double rate_hz) {
    std::string text = "t," + name + "\n";
    for (int i = 0; i < int(4. * rate_hz); ++i) {
      double value = 0.;
      for (const double hz : {31., 198., 207., 215., 223., 231.})
        value += std::sin(2. * std::numbers::pi * hz * i / rate_hz + hz);
      text += to_text(i / rate_hz) + "," + to_text(value) + "\n";
    }
    return text;
  };
  const Recording slow = read("m.csv", near_the_edge("m", 500.), "base_moment=m");
  const Recording fast = read("a.csv", near_the_edge("ax", 1000.), "base_acceleration=ax");
  const Record record = joined(fast, slow).pieces.front();
  const auto a = record.channel(channel::base_acceleration);
  const auto m = record.channel(channel::base_moment);
  for (std::size_t i = 0; i < record.n_samples(); ++i) ASSERT_NEAR(a[i], m[i], 2e-3) << i;
}

TEST_F(Joined, RefusesRecordingsThatDoNotOverlap) {
  const Recording slow = read("m.csv", table("m", 500., 0., 2.), "base_moment=m");
  const Recording late = read("a.csv", table("ax", 500., 10., 2.), "base_acceleration=ax");
  EXPECT_THAT([&] { joined(slow, late); }, ThrowsMessage<UserError>(HasSubstr("at the same time")));
  EXPECT_THAT([&] { joined(slow, slow); }, ThrowsMessage<UserError>(HasSubstr("both files")));
}

}  // namespace
}  // namespace vibrissa::signals
