#include "diagnosis/checks/data_checks.h"

#include <gmock/gmock.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using testing::Contains;
using testing::IsEmpty;
using testing::Not;

using Change = std::function<void(signals::DatasetRecord&)>;

/// Kinds of findings in a correct dataset after a change of each record.
std::vector<std::string> kinds(const Change& change, const test::RigDatasetOptions& options = {},
                               double simulated_rate_hz = 0.) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig(), options);
  for (signals::DatasetRecord& entry : dataset.records) change(entry);
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, options.wind);
  std::vector<std::string> out;
  for (const Finding& finding : check_data(nominal, dataset, simulated_rate_hz)) {
    out.push_back(to_string(finding.kind));
    EXPECT_THAT(finding.message, Not(IsEmpty()));
  }
  return out;
}

void change_channel(signals::DatasetRecord& entry, const std::string& name,
                    const std::function<double(double)>& f) {
  const auto values = entry.record.channel(name);
  std::vector<double> changed(values.begin(), values.end());
  for (double& v : changed) v = f(v);
  entry.record.set_channel(name, std::move(changed));
}

Change scaled(const std::string& name, double factor) {
  return [=](signals::DatasetRecord& entry) {
    change_channel(entry, name, [=](double v) { return factor * v; });
  };
}

signals::DatasetRecord without(const signals::DatasetRecord& entry, const std::string& name) {
  signals::DatasetRecord out = entry;
  out.record = signals::Record(entry.record.sampling_rate_hz(), entry.record.n_samples());
  for (const std::string& channel : entry.record.channel_names()) {
    const auto x = entry.record.channel(channel);
    if (channel != name) out.record.set_channel(channel, {x.begin(), x.end()});
  }
  return out;
}

void nothing(signals::DatasetRecord&) {}

namespace channel = signals::channel;

TEST(DataChecks, HealthyRecordsHaveNoFindings) {
  EXPECT_THAT(kinds(nothing, {.wind = true}), IsEmpty());
}

TEST(DataChecks, HealthyRecordsOfAConverterHaveNoFindings) {
  EXPECT_THAT(kinds([](signals::DatasetRecord& entry) {
                change_channel(entry, channel::base_acceleration, [](double v) {
                  return 0.0383 * std::round(v / 0.0383);  // 3.9 mg
                });
              }),
              IsEmpty());
}

TEST(DataChecks, NoticesAClippedChannel) {
  EXPECT_THAT(kinds([](signals::DatasetRecord& entry) {
                change_channel(entry, channel::base_acceleration,
                               [](double v) { return std::clamp(v, -6., 6.); });
              }),
              Contains("clipped_channel"));
}

TEST(DataChecks, NoticesSwappedColumns) {
  const auto found = kinds([](signals::DatasetRecord& entry) {
    const auto a = entry.record.channel(channel::base_acceleration),
               m = entry.record.channel(channel::base_moment);
    std::vector<double> moment(m.begin(), m.end()), acceleration(a.begin(), a.end());
    entry.record.set_channel(channel::base_acceleration, std::move(moment));
    entry.record.set_channel(channel::base_moment, std::move(acceleration));
  });
  EXPECT_THAT(found, Contains("swapped_columns"));
  EXPECT_THAT(found, Not(Contains("wrong_unit")));
}

TEST(DataChecks, NoticesExchangedAxes) {
  const auto found = kinds([](signals::DatasetRecord& entry) {
    const auto a = entry.record.channel(channel::base_acceleration);
    entry.record.set_channel(channel::cross_acceleration, {a.begin(), a.end()});
    if (entry.excitation.base) scaled(channel::base_acceleration, 0.05)(entry);
  });
  EXPECT_THAT(found, Contains("swapped_columns"));
}

TEST(DataChecks, NoticesAccelerationInG) {
  EXPECT_THAT(kinds(scaled(channel::base_acceleration, 1. / 9.80665)), Contains("wrong_unit"));
}

TEST(DataChecks, NoticesMomentInMillinewtonMillimetres) {
  const auto found = kinds(scaled(channel::base_moment, 1e6));
  EXPECT_THAT(found, Contains("wrong_unit"));
  EXPECT_THAT(found, Not(Contains("swapped_columns")));
}

TEST(DataChecks, NoticesWindInKilometresPerHour) {
  EXPECT_THAT(kinds(scaled(channel::wind_speed, 3.6), {.wind = true}), Contains("wrong_unit"));
}

TEST(DataChecks, NoticesWindInCentimetresPerSecond) {
  EXPECT_THAT(kinds(scaled(channel::wind_speed, 100.), {.wind = true}), Contains("wrong_unit"));
}

TEST(DataChecks, NoticesAFactorThatNoUnitGives) {
  EXPECT_THAT(kinds(scaled(channel::base_moment, 1e-3)), Contains("wrong_unit"));
  EXPECT_THAT(kinds(scaled(channel::base_moment, 100.)), Contains("wrong_unit"));
}

TEST(DataChecks, NoticesAWrongUnitInOneRecordOfBaseAndWind) {
  const auto found = kinds(
      [](signals::DatasetRecord& entry) {
        if (entry.name == "held_out") scaled(channel::base_moment, 1e3)(entry);
      },
      {.wind = true});
  EXPECT_THAT(found, testing::ElementsAre("wrong_unit"));
}

TEST(DataChecks, NoticesAMomentOrAnAccelerationOfTheOppositeSign) {
  const auto moment = kinds(scaled(channel::base_moment, -1.), {.wind = true});
  EXPECT_EQ(std::count(moment.begin(), moment.end(), "reversed_sign"), 3);  // two base, one wind
  const auto base = kinds(scaled(channel::base_acceleration, -1.), {.wind = true});
  EXPECT_EQ(std::count(base.begin(), base.end(), "reversed_sign"), 2);
}

TEST(DataChecks, TakesAMuchSofterOrLaterSensorForNoOppositeSign) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.3;
  rig.delay_s = 4e-3;
  const signals::Dataset dataset = test::rig_dataset(rig, {.wind = true});
  EXPECT_THAT(check_data(test::nominal_of(test::OneModeRig{}, true), dataset), IsEmpty());
}

TEST(DataChecks, TakesNoiseBelowANarrowBandForNoWrongUnit) {
  test::OneModeRig rig = test::noisy_rig();
  rig.moment_noise =
      1e-8;  // a hundredth of the moment that the accelerometer's noise would cause as motion
  signals::Dataset dataset = test::rig_dataset(rig);
  dataset.records.push_back(
      {"narrow",
       rig.record(1024, 1., test::sines(test::odd_lines_hz(500. / 512., 25., 45.), 2., 5),
                  test::no_signal, 6, false),
       {true, false},
       512,
       signals::Split::fit,
       signals::Readout::moment});
  EXPECT_THAT(check_data(test::nominal_of(test::OneModeRig{}, false), dataset), IsEmpty());
}

TEST(DataChecks, NoticesTimeInMilliseconds) {
  EXPECT_THAT(kinds([](signals::DatasetRecord& entry) {
                signals::Record slow(1e-3 * entry.record.sampling_rate_hz(),
                                     entry.record.n_samples());
                for (const std::string& name : entry.record.channel_names()) {
                  const auto x = entry.record.channel(name);
                  slow.set_channel(name, {x.begin(), x.end()});
                }
                entry.record = std::move(slow);
              }),
              Contains("wrong_unit"));
}

TEST(DataChecks, SaysWhichRecordsAreTooShort) {
  const auto found = kinds([](signals::DatasetRecord& entry) {
    if (entry.name == "held_out") entry.record = entry.record.slice(0, 200);
  });
  EXPECT_THAT(found, testing::ElementsAre("too_short", "no_held_out"));
}

TEST(DataChecks, SaysWhatCannotBeToldWithoutWindOrBaseMotion) {
  const auto without_wind =
      kinds([](signals::DatasetRecord& entry) { entry = without(entry, channel::wind_speed); },
            {.wind = true});
  EXPECT_THAT(without_wind, Contains("no_wind"));
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig(), {.wind = true});
  std::erase_if(dataset.records, [](const auto& entry) { return entry.excitation.base; });
  const auto findings = check_data(test::nominal_of(test::OneModeRig{}, true), dataset);
  EXPECT_THAT(findings, Contains(testing::Field(&Finding::kind, FindingKind::no_base_motion)));
}

TEST(DataChecks, DoubtsAFactorThatNoSensorIsOffBy) {
  EXPECT_THAT(kinds(scaled(channel::base_moment, 2.6)), testing::Each("unlikely_gain"));
  EXPECT_THAT(kinds(scaled(channel::base_moment, 2.6)), Contains("unlikely_gain"));
}

TEST(DataChecks, TakesAGainOffByAThirdForNoWrongUnit) {
  EXPECT_THAT(kinds(scaled(channel::base_moment, 1.33)), IsEmpty());
  EXPECT_THAT(kinds(scaled(channel::base_moment, 0.67)), IsEmpty());
}

TEST(DataChecks, NoticesRepeatedSamples) {
  EXPECT_THAT(kinds([](signals::DatasetRecord& entry) {
                const auto a = entry.record.channel(channel::base_acceleration);
                std::vector<double> repeated(a.begin(), a.end());
                for (std::size_t i = 5; i < repeated.size(); i += 5) repeated[i] = repeated[i - 1];
                entry.record.set_channel(channel::base_acceleration, std::move(repeated));
              }),
              Contains("repeated_samples"));
}

TEST(DataChecks, NoticesWhatIsMissing) {
  EXPECT_THAT(kinds(nothing, {.quiet = false}), testing::ElementsAre("no_quiet_record"));
  EXPECT_THAT(kinds(nothing, {.held_out = false}), testing::ElementsAre("no_held_out"));
  EXPECT_THAT(kinds(nothing, {.low_level = 3.9}), testing::ElementsAre("one_level"));
  EXPECT_THAT(
      kinds([](signals::DatasetRecord& entry) { entry = without(entry, channel::wind_speed); },
            {.wind = true}),
      Contains("missing_wind"));
  EXPECT_THAT(kinds([](signals::DatasetRecord& entry) {
                entry = without(entry, channel::base_acceleration);
              }),
              Contains("missing_acceleration"));
}

TEST(DataChecks, NamesADifferentSamplingRate) {
  EXPECT_THAT(kinds(nothing, {}, 1000.), testing::ElementsAre("different_rate"));
  EXPECT_THAT(kinds(nothing, {}, 500.), IsEmpty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
