#include "checks/check_record.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "checks/serves.h"
#include "separation/model/simulation.h"
#include "tests/checks/record_generator.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::checks {
namespace {

using diagnosis::FindingKind;
using test::Drive;
using test::Fault;

std::string words_of(const RecordReport& report) {
  std::string text;
  for (const Finding& finding : report.findings)
    text += "\n  " + to_string(finding.severity) + " " + diagnosis::to_string(finding.kind) + ": " +
            finding.sentence;
  return text;
}

bool is_clean(const RecordReport& report) {
  const ServesTable table = what_it_serves(report);
  return std::ranges::all_of(report.findings,
                             [](const Finding& f) { return f.severity == Severity::note; }) &&
         std::ranges::all_of(table,
                             [](const CommandVerdict& v) { return v.serves == Serves::good; });
}

bool is_named(const test::BadRecord& bad, const RecordReport& report) {
  const bool has_finding = std::ranges::any_of(report.findings, [&](const Finding& f) {
    return f.kind == bad.expected && f.severity != Severity::note;
  });
  const ServesTable table = what_it_serves(report);
  const bool is_worse =
      std::ranges::any_of(table, [](const CommandVerdict& v) { return v.serves != Serves::good; });
  return has_finding && is_worse && (!bad.stops_identify || table[0].serves == Serves::no);
}

constexpr std::size_t n_good = 60, n_bad = 60, most_wrong = 4;

/// How many of 60 good and 60 bad records are called what they are not.
std::size_t n_wrong_of_120(const std::uint64_t first_seed) {
  std::size_t n_wrong = 0;
  for (std::size_t i = 0; i < n_good; ++i) {
    const RecordReport report =
        check_record(test::good_record(static_cast<Drive>(i % 4), first_seed + i));
    if (is_clean(report)) continue;
    ++n_wrong;
    std::cout << "good record " << i << " (drive " << i % 4 << "):" << words_of(report) << "\n";
  }
  for (std::size_t i = 0; i < n_bad; ++i) {
    const test::BadRecord bad =
        test::bad_record(static_cast<Fault>(i % test::n_faults), first_seed + 1000 + i);
    const RecordReport report = check_record(bad.record);
    if (is_named(bad, report)) continue;
    ++n_wrong;
    std::cout << "bad record " << i << " (" << bad.name << "):" << words_of(report) << "\n";
  }
  std::cout << n_good + n_bad - n_wrong << " of " << n_good + n_bad << " right\n";
  return n_wrong;
}

/// White up to half the rate, held between samples, as a digital drive is; its moment has noise.
signals::Record white_record(const std::uint64_t seed, const double noise) {
  const auto a = separation::test::white_noise(15000, 3., seed);
  const auto m = separation::simulate(separation::test::sensor(2, -2e-5), a,
                                      separation::test::rate_hz, separation::Hold::zero_order);
  signals::Record record(separation::test::rate_hz, a.size());
  record.set_channel(signals::channel::base_acceleration, a);
  record.set_channel(signals::channel::base_moment,
                     separation::test::plus_noise(m, noise * separation::test::rms(m), seed + 1));
  return record;
}

TEST(CheckRecord, AWhiteDriveUpToHalfTheRateIsNotAliased) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const RecordReport report = check_record(white_record(seed, 1e-3));
    EXPECT_TRUE(std::ranges::none_of(report.findings, [](const Finding& f) {
      return f.kind == diagnosis::FindingKind::possible_aliasing;
    })) << words_of(report);
  }
}

/// 60 s at 25 Hz of a mode of 0.32 Hz that decays by e in 50 s: no segment resolves it.
signals::Record narrow_record(const std::uint64_t seed) {
  constexpr double rate_hz = 25.;
  const separation::Bvrm sensor{.modes = {separation::make_modal_term(0.32, 0.01, -1.)}};
  const auto a = separation::test::white_noise(1500, 0.3, seed);
  const auto m = separation::simulate(sensor, a, rate_hz, separation::Hold::zero_order);
  signals::Record record(rate_hz, a.size());
  record.set_channel(signals::channel::base_acceleration, a);
  record.set_channel(signals::channel::base_moment,
                     separation::test::plus_noise(m, 0.02 * separation::test::rms(m), seed + 1));
  return record;
}

TEST(CheckRecord, AResonanceNarrowerThanTheLinesFollows) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const RecordReport report = check_record(narrow_record(seed));
    EXPECT_NE(what_it_serves(report)[0].serves, Serves::no) << seed << words_of(report);
  }
}

/// The moment leads by 20 ms; its noise is this share of it.
signals::Record leading_record(const double noise) {
  separation::Bvrm sensor = separation::test::sensor(1);
  sensor.delay_s = -0.02;
  const auto a = separation::test::white_noise(15000, 3., 4);
  const auto m = separation::simulate(sensor, a, separation::test::rate_hz);
  signals::Record record(separation::test::rate_hz, a.size());
  record.set_channel(signals::channel::base_acceleration, a);
  record.set_channel(signals::channel::base_moment,
                     separation::test::plus_noise(m, noise * separation::test::rms(m), 5));
  return record;
}

TEST(CheckRecord, SaysADelayAlsoWhereNoiseMakesTheModelNotUsable) {
  for (const double noise : {0.05, 1.4}) {
    const RecordReport report = check_record(leading_record(noise));
    const auto has = [&](const FindingKind kind) {
      return std::ranges::any_of(report.findings, [&](const Finding& f) { return f.kind == kind; });
    };
    EXPECT_TRUE(has(FindingKind::channel_delay)) << words_of(report);
    EXPECT_EQ(has(FindingKind::no_usable_model), noise > 1.) << words_of(report);
  }
}

// The seeds are the numbers of the records: none was chosen.
TEST(CheckRecord, IsRightOnGoodAndBadRecords) {
  EXPECT_LE(n_wrong_of_120(1000), most_wrong);
}

TEST(LongCheckRecord, IsRightOnFurtherRecords) {
  for (const std::uint64_t first_seed : {10000, 20000, 30000})
    EXPECT_LE(n_wrong_of_120(first_seed), most_wrong) << first_seed;
}

}  // namespace
}  // namespace vibrissa::checks
