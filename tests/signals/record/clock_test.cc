#include "signals/record/clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A device that samples evenly, and how it stamps its samples.
struct Device {
  double rate_hz = 487.;
  std::size_t n = 10000;
  double jitter_periods = 0.;  // standard deviation
  double lost_share = 0.;
  std::size_t packet = 1;   // samples that share one stamp
  std::size_t burst = 1;    // samples stamped quickly one after the other when they are read
  double drift = 0.;        // relative change of the rate over the record
  double unit_s = 1e-6;     // of the stamps, which are whole numbers
  double range = 0.;        // of the counter, in units; 0: it does not wrap
  double burst_step = 0.1;  // between stamps of a burst, in periods
  unsigned seed = 1;
};

struct Stamps {
  std::vector<double> times_s;
  std::set<std::size_t> first_behind_loss;  // rows
  std::size_t n_lost = 0;
  TimeDigits digits;
};

Stamps stamps_of(const Device& device) {
  std::mt19937_64 random(device.seed);
  std::normal_distribution<> normal;
  std::uniform_real_distribution<> uniform;
  Stamps stamps;
  const double period_s = 1. / device.rate_hz;
  double jitter = 0.;
  for (std::size_t k = 0; k < device.n; ++k) {
    const std::size_t group = std::max(device.packet, device.burst);
    const bool begins = k % group == 0;
    if (begins && k > 0 && uniform(random) < device.lost_share * double(device.packet)) {
      k += device.packet - 1;
      stamps.n_lost += device.packet;
      stamps.first_behind_loss.insert(stamps.times_s.size());
      continue;
    }
    if (begins || device.packet == 1) jitter = device.jitter_periods * normal(random);
    const std::size_t read_at = k / group * group + group - 1;
    const double sample = device.packet > 1 ? double(read_at)
                          : device.burst > 1
                              ? double(read_at) + device.burst_step * double(k % group)
                              : double(k);
    const double turned = sample * (1. + device.drift * (sample / double(device.n) - 1.) / 2.);
    double ticks = std::round((10. + (turned + jitter) * period_s) / device.unit_s);
    if (device.range > 0.) ticks = std::fmod(ticks, device.range);
    char text[40];
    std::snprintf(text, sizeof text, "%.0f", ticks);
    stamps.digits.see(text);
    stamps.times_s.push_back(ticks * device.unit_s);
  }
  return stamps;
}

Clock clock_of(const Stamps& stamps, const double unit_s) {
  return find_clock({.times_s = stamps.times_s,
                     .digits = stamps.digits,
                     .unit_s = unit_s,
                     .file = "r.csv",
                     .column = "t"});
}

// Losses that are found within a few samples of their place.
std::size_t n_found(const Stamps& stamps, const Clock& clock) {
  constexpr std::size_t near = 4;
  std::size_t n = 0;
  for (const std::size_t row : stamps.first_behind_loss)
    n += std::any_of(clock.pieces.begin() + 1, clock.pieces.end(), [&](const ClockPiece& piece) {
      return piece.first + near >= row && piece.first <= row + near;
    });
  return n;
}

std::vector<Device> forty_devices() {
  std::vector<Device> devices;
  unsigned seed = 100;
  for (const double jitter : {0., 0.05, 0.1, 0.2, 0.3})
    for (const double lost : {0., 0.001, 0.005, 0.01})
      devices.push_back({.jitter_periods = jitter, .lost_share = lost, .seed = ++seed});
  for (const double rate_hz : {100., 523.7, 3200.})
    for (const double lost : {0., 0.005})
      devices.push_back({.rate_hz = rate_hz,
                         .jitter_periods = 0.3,
                         .lost_share = lost,
                         .packet = 3,
                         .seed = ++seed});
  for (const std::size_t burst : {4u, 8u, 16u}) devices.push_back({.burst = burst, .seed = ++seed});
  for (const double drift : {1e-5, 1e-4, 1e-3})
    devices.push_back({.jitter_periods = 0.1, .lost_share = 0.002, .drift = drift, .seed = ++seed});
  for (const double range : {65536., 16777216.})
    for (const double jitter : {0., 0.2})
      devices.push_back({.n = 60000,
                         .jitter_periods = jitter,
                         .lost_share = 0.001,
                         .unit_s = 1e-5,
                         .range = range,
                         .seed = ++seed});
  for (const double jitter : {0.1, 0.2, 0.3, 0.25})  // milliseconds of an Arduino
    devices.push_back(
        {.jitter_periods = jitter, .lost_share = 0.003, .unit_s = 1e-3, .seed = ++seed});
  return devices;
}

TEST(Clock, FindsRateAndLostSamplesOfFortyDevices) {
  std::size_t n_right = 0, n_lost = 0, n_found_in_all = 0, n_false = 0;
  const std::vector<Device> devices = forty_devices();
  ASSERT_EQ(devices.size(), 40u);
  for (const Device& device : devices) {
    const Stamps stamps = stamps_of(device);
    const Clock clock = clock_of(stamps, device.unit_s);
    const double off_hz = std::abs(clock.sampling_rate_hz - device.rate_hz);
    const double rounding_hz = 1e-12 * device.rate_hz;
    // A drifting device has its nominal rate as the mean.
    const bool is_right = off_hz <= 3. * clock.rate_error_hz + rounding_hz ||
                          (clock.rate_error_hz == 0. && off_hz <= 1e-4 * device.rate_hz);
    n_right += is_right;
    EXPECT_EQ(clock.words.find("in packets of 3 with one stamp") != std::string::npos,
              device.packet == 3)
        << clock.words;
    EXPECT_TRUE(is_right) << device.seed << ": " << clock.words << ", true " << device.rate_hz;
    n_lost += stamps.first_behind_loss.size();
    n_found_in_all += n_found(stamps, clock);
    const std::size_t found = clock.pieces.size() - 1;
    if (found > stamps.first_behind_loss.size()) n_false += found - stamps.first_behind_loss.size();
    EXPECT_NEAR(double(clock.n_lost), double(stamps.n_lost), 0.01 * double(stamps.n_lost) + 1e-9)
        << device.seed << ": " << clock.words;
  }
  EXPECT_EQ(n_right, devices.size());
  EXPECT_GE(double(n_found_in_all), 0.99 * double(n_lost));
  EXPECT_LE(double(n_false), 0.01 * double(n_lost));
}

TEST(Clock, FindsTheFewLossesOfALongRecord) {
  const Device device{.n = 300000, .jitter_periods = 0.1, .lost_share = 1e-4};
  const Stamps stamps = stamps_of(device);
  const Clock clock = clock_of(stamps, device.unit_s);
  EXPECT_EQ(clock.n_lost, stamps.n_lost);
  EXPECT_EQ(n_found(stamps, clock), stamps.first_behind_loss.size());
  EXPECT_EQ(clock.pieces.size(), stamps.first_behind_loss.size() + 1);
  EXPECT_NEAR(clock.sampling_rate_hz, device.rate_hz, 4. * clock.rate_error_hz);
}

TEST(Clock, IsTheExactGridWhereTheStampsAreOne) {
  const Stamps stamps = stamps_of({.rate_hz = 500.});
  const Clock clock = clock_of(stamps, 1e-6);
  EXPECT_EQ(clock.sampling_rate_hz, 500.);
  EXPECT_EQ(clock.rate_error_hz, 0.);
  EXPECT_EQ(clock.pieces.size(), 1u);
}

TEST(Clock, KeepsTheTimeOfAPieceBehindALongGap) {
  Stamps stamps = stamps_of({.rate_hz = 25., .n = 1000, .unit_s = 1e-3});
  for (std::size_t i = 400; i < 1000; ++i) stamps.times_s[i] += 550.6;
  const Clock clock = clock_of(stamps, 1e-3);
  ASSERT_EQ(clock.pieces.size(), 2u);
  EXPECT_EQ(clock.pieces[1].first, 400u);
  EXPECT_NEAR(clock.pieces[1].start_s, 10. + 16. + 550.6, 0.01);
  EXPECT_EQ(clock.n_lost, 13765u);
}

TEST(Clock, TakesBurstsOfABufferAtTheirMeanRate) {
  // Steps of 198 and 596 us in no order: samples of one device, read when there is time.
  std::mt19937_64 random(3);
  std::vector<double> times{12.8};
  double behind = 0.;
  for (int i = 1; i < 6000; ++i) {
    const bool is_long = behind > 0. || (behind > -2e-3 && random() % 4 == 0);
    const double step = is_long ? 596e-6 : 198e-6;
    behind += 297.5e-6 - step;
    times.push_back(times.back() + step);
  }
  TimeDigits digits;
  digits.see("12.830844");
  const Clock clock = find_clock({.times_s = times, .digits = digits, .file = "r.csv"});
  EXPECT_NEAR(clock.sampling_rate_hz, 1. / 297.5e-6, 3. * clock.rate_error_hz);
  EXPECT_LT(clock.rate_error_hz, 5e-3 * clock.sampling_rate_hz);
  EXPECT_EQ(clock.pieces.size(), 1u);
  EXPECT_THAT(clock.words, HasSubstr("bursts"));
}

// A buffer that is read whenever it is full: its stamps stay at a line, which tells the rate.
TEST(Clock, TakesFullBuffersAtTheRateOfTheLineThroughTheirStamps) {
  for (std::size_t burst = 4; burst <= 16; ++burst)
    for (const double step : {0.02, 0.1})
      for (const double rate_hz : {232.9, 487., 1185.6}) {
        const Device device{.rate_hz = rate_hz, .burst = burst, .burst_step = step};
        const Clock clock = clock_of(stamps_of(device), device.unit_s);
        EXPECT_NEAR(clock.sampling_rate_hz, rate_hz, 3. * clock.rate_error_hz) << clock.words;
        EXPECT_LT(clock.rate_error_hz, 2e-5 * rate_hz) << clock.words;
        EXPECT_EQ(clock.n_lost, 0u) << clock.words;
      }
}

// A buffer whose delay wanders over a tenth of the record: a line through its stamps follows the
// delay, and its error would be stated a third of what it is.
TEST(Clock, StatesTheErrorOfBurstsWhoseDelayWanders) {
  constexpr double period_s = 297.5e-6, delay_s = 2e-3;
  constexpr std::size_t n = 6000, n_draws = 40;
  TimeDigits digits;
  digits.see("12.830844");
  std::mt19937_64 random(1);
  std::normal_distribution<> normal;
  const double kept = std::exp(-1. / (0.1 * double(n)));
  std::size_t n_outside = 0;
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    double late_s = delay_s * normal(random);
    std::vector<double> times{12.8 + late_s};
    for (std::size_t i = 1; i < n; ++i) {
      late_s = kept * late_s + delay_s * std::sqrt(1. - kept * kept) * normal(random);
      const double due_s = 12.8 + double(i) * period_s + late_s;
      times.push_back(times.back() + (due_s > times.back() + 4e-4 ? 596e-6 : 198e-6));
    }
    const Clock clock = find_clock({.times_s = times, .digits = digits, .file = "r.csv"});
    EXPECT_THAT(clock.words, HasSubstr("bursts"));
    n_outside += std::abs(clock.sampling_rate_hz - 1. / period_s) > 3. * clock.rate_error_hz;
  }
  EXPECT_LE(n_outside, 3u) << "one in a hundred is expected";
}

TEST(Clock, TakesIntervalsInPlaceOfTimes) {
  std::mt19937_64 random(4);
  std::vector<double> intervals;
  for (int i = 0; i < 2000; ++i) intervals.push_back(2e-3 + 1e-6 * double(random() % 20));
  TimeDigits digits;
  digits.see("0.002001");
  const Clock clock = find_clock({.times_s = intervals, .digits = digits, .file = "r.csv"});
  EXPECT_NEAR(clock.sampling_rate_hz, 1. / 2.0095e-3, 0.3);
  EXPECT_THAT(clock.words, HasSubstr("intervals"));
}

TEST(Clock, SeparatesRecordingsThatBeginAnew) {
  std::vector<double> times;
  for (int block = 0; block < 3; ++block)
    for (int i = 0; i < 200; ++i) times.push_back(i * 0.002);
  TimeDigits digits;
  digits.see("0.002");
  const Clock clock = find_clock({.times_s = times, .digits = digits, .file = "r.csv"});
  EXPECT_EQ(clock.pieces.size(), 3u);
  EXPECT_EQ(clock.sampling_rate_hz, 500.);
  EXPECT_EQ(clock.n_lost, 0u);
}

// 25 Hz; every 100th stamp is that of the sample before it, and the stamps catch up four samples
// later; 1000 samples are lost in the middle.
TEST(Clock, NamesStampsThatStandTwiceAndLosesNoMoreThanTheSpanHolds) {
  Stamps stamps;
  const std::size_t n = 4000;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = i + (i < n / 2 ? 0 : 1000);
    const bool is_late = i % 100 >= 50 && i % 100 < 54;
    char text[40];
    std::snprintf(text, sizeof text, "%.2f", 0.04 * double(is_late ? k - 1 : k));
    stamps.digits.see(text);
    stamps.times_s.push_back(std::stod(text));
  }
  const Clock clock = clock_of(stamps, 1.);
  EXPECT_LE(clock.n_lost, 1001u);
  EXPECT_GE(clock.n_lost, 999u);
  EXPECT_THAT(clock.words, HasSubstr("; 40 stamps stand twice"));
}

TEST(Clock, RefusesSamplingThatIsNotEven) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<> uniform(0.5, 1.5);
  std::vector<double> times{0.};
  for (int i = 1; i < 3000; ++i) times.push_back(times.back() + 0.002 * uniform(random));
  TimeDigits digits;
  digits.see("0.00212345");
  EXPECT_THAT([&] { find_clock({.times_s = times, .digits = digits, .file = "r.csv"}); },
              ThrowsMessage<UserError>(HasSubstr("--resample")));
}

TEST(Clock, RefusesATimeThatRunsBackward) {
  std::vector<double> times;
  for (int i = 0; i < 300; ++i) times.push_back(0.002 * (i == 40 ? 38.5 : i));
  TimeDigits digits;
  digits.see("0.5990");
  EXPECT_THAT([&] { find_clock({.times_s = times, .digits = digits, .file = "r.csv"}); },
              ThrowsMessage<UserError>(HasSubstr("time decreases between line 41")));
}

}  // namespace
}  // namespace vibrissa::signals
