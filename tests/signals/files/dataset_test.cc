#include "signals/files/dataset.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "signals/base/error.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::HasSubstr;

std::string dataset_csv(bool base, bool wind, std::size_t n = 128) {
  std::string text = "time_s,base_acceleration_m_s2,wind_speed_m_s,base_moment_N_m\n";
  for (std::size_t i = 0; i < n; ++i) {
    const double x = std::sin(0.7 * static_cast<double>(i));
    text += std::to_string(0.002 * static_cast<double>(i)) + "," + std::to_string(base ? x : 0.) +
            "," + std::to_string(wind ? 2. + x : 0.) + "," + std::to_string(x) + "\n";
  }
  return text;
}

TEST(ShortReadings, AreOneLineWhereFilesAreReadAlike) {
  const FileReading a{"b/a.csv", "commas; 500 Hz from 't'; 128 samples, 0.256 s; ax = m"},
      b{"b/b.csv", "commas; 500 Hz from 't'; 4096 samples, 8.2 s; ax = m"},
      c{"b/c.csv", "commas; 400 Hz from 't'; 128 samples, 0.32 s; ax = m"};
  EXPECT_THAT(
      short_readings({a, b}),
      ::testing::ElementsAre("2 files (b/a.csv, ...) read as: commas; 500 Hz from 't'; ax = m"));
  EXPECT_THAT(short_readings({a, b, c}),
              ::testing::ElementsAre(to_string(a), to_string(b), to_string(c)));
  EXPECT_THAT(short_readings({a}), ::testing::ElementsAre("b/a.csv: read as: " + a.words));
}

class DatasetFolder : public ::testing::Test {
 protected:
  DatasetFolder() {
    folder_.file("a.csv", dataset_csv(true, false));
    folder_.file("b.csv", dataset_csv(true, true));
  }
  void describe(const std::string& entries, const std::string& more = "") {
    folder_.file("dataset.json", R"({"schema": "vibrissa-dataset-1", "sampling_rate_hz": 500)" +
                                     more + R"(, "records": [)" + entries + "]}");
  }
  void expect_refused(const std::string& entries, const std::string& why) {
    describe(entries);
    expect_error(why);
  }
  void expect_error(const std::string& why) {
    try {
      read_dataset(folder_.path());
      FAIL() << "was accepted; expected: " << why;
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
  }
  test::TemporaryFolder folder_;
};

TEST_F(DatasetFolder, ReadsWhatTheDescriptionSays) {
  describe(R"({"file": "a.csv", "excitation": "base", "period_samples": 64},
              {"file": "b.csv", "excitation": "base+wind", "split": "held_out",
               "readout": "rotation"})");
  const Dataset dataset = read_dataset(folder_.path());
  ASSERT_EQ(dataset.records.size(), 2u);
  EXPECT_THAT(dataset.guesses, ::testing::IsEmpty());
  const DatasetRecord &a = dataset.records[0], &b = dataset.records[1];
  EXPECT_EQ(a.name, "a");
  EXPECT_EQ(a.excitation, (Excitation{true, false}));
  EXPECT_EQ(a.period_samples, 64u);
  EXPECT_EQ(a.split, Split::fit);
  EXPECT_EQ(a.readout, Readout::moment);
  EXPECT_EQ(a.record.sampling_rate_hz(), 500.);
  EXPECT_EQ(to_string(b.excitation), "base+wind");
  EXPECT_EQ(b.split, Split::held_out);
  EXPECT_EQ(b.readout, Readout::rotation);
}

TEST_F(DatasetFolder, TakesTheReadoutOfTheWholeDataset) {
  describe(R"({"file": "a.csv", "excitation": "base"})", R"(, "readout": "rotation")");
  EXPECT_EQ(read_dataset(folder_.path()).records[0].readout, Readout::rotation);
}

TEST_F(DatasetFolder, AcceptsTheSetUpOfTheBench) {
  describe(R"({"file": "a.csv", "excitation": "base", "setup": {"tilt_deg": 90}},
              {"file": "a.csv", "excitation": "base",
               "setup": {"added_mass_kg": 1e-4, "added_mass_height_m": 0.15, "rotation_deg": -90,
                         "stage": "clamped", "coil_driven": false, "magnet": false}},
              {"file": "a.csv", "excitation": "base"})",
           R"(, "setup": {"magnet": false})");
  const Dataset dataset = read_dataset(folder_.path());
  EXPECT_EQ(dataset.records[0].setup, BenchSetup{.tilt_deg = 90.});
  EXPECT_EQ(dataset.records[1].setup,
            (BenchSetup{1e-4, 0.15, 0., -90., Stage::clamped, false, false}));
  EXPECT_EQ(to_string(dataset.records[1].setup),
            "0.1 g added at 150 mm, turned by -90 degrees, stage clamped, coil not driven, magnet "
            "removed");
  EXPECT_EQ(dataset.records[2].setup, BenchSetup{.magnet = false});
}

TEST_F(DatasetFolder, RefusesASetUpThatIsNone) {
  const auto refused = [&](const std::string& setup, const std::string& why) {
    expect_refused(R"({"file": "a.csv", "excitation": "base", "setup": )" + setup + "}", why);
  };
  refused("90", "/records/0/setup: must be an object");
  refused(R"({"tilt": 90})", "tilt_deg");
  refused(R"({"tilt_deg": "steep"})", "/setup/tilt_deg: must be a number");
  refused(R"({"added_mass_kg": -1})", "must not be negative");
  refused(R"({"stage": "loose"})", "clamped");
  refused(R"({"magnet": 1})", "true or false");
}

TEST_F(DatasetFolder, GuessesWhatNobodyDescribedAndSaysSo) {
  const Dataset dataset = read_dataset(folder_.path());
  ASSERT_EQ(dataset.records.size(), 4u);
  EXPECT_EQ(dataset.guesses.size(), 2u);
  EXPECT_EQ(dataset.records[0].excitation, (Excitation{true, false}));
  EXPECT_EQ(dataset.records[2].excitation, (Excitation{true, true}));
  EXPECT_EQ(dataset.records[0].record.n_samples(), 85u);
  EXPECT_EQ(dataset.records[1].record.n_samples(), 43u);
  EXPECT_EQ(dataset.records[1].split, Split::held_out);
  EXPECT_EQ(dataset.records[0].clock_start_s, 0.);
  EXPECT_DOUBLE_EQ(dataset.records[1].clock_start_s, 85 / 500.);
}

TEST(DatasetGuess, TakesNoiseOfTheAccelerometerForNoDriveButAFaintDriveForOne) {
  const test::TemporaryFolder folder;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0., 0.05);
  const std::string head = "time_s,base_acceleration_m_s2,base_moment_N_m\n";
  std::string noise = head, faint = head;
  for (int i = 0; i < 3000; ++i) {
    const std::string time = std::to_string(0.002 * i) + ",";
    noise += time + std::to_string(9.81 + normal(random)) + ",1e-6\n";
    faint += time + std::to_string(0.05 * std::sin(0.7 * i) + normal(random)) + ",1e-6\n";
  }
  folder.file("faint.csv", faint);
  folder.file("noise.csv", noise);
  const Dataset dataset = read_dataset(folder.path());
  ASSERT_EQ(dataset.records.size(), 4u);
  EXPECT_EQ(dataset.records[0].excitation, (Excitation{true, false}));
  EXPECT_EQ(dataset.records[2].excitation, (Excitation{false, false}));
}

// An earthquake: what is left in the last third is a decay without a drive.
TEST(DatasetGuess, HoldsOutAWholeRecordWhereTheBaseRestsInTheLastThirds) {
  const test::TemporaryFolder folder;
  for (const double rate : {0.3, 0.4, 0.5}) {
    std::string text = "time_s,base_acceleration_m_s2,base_moment_N_m\n";
    for (int i = 0; i < 900; ++i)
      text += std::to_string(0.02 * i) + "," +
              std::to_string(i < 500 ? std::sin(rate * i) : 0.01 * std::sin(0.1 * i)) + "," +
              std::to_string(std::sin(0.2 * i)) + "\n";
    folder.file("r" + std::to_string(rate) + ".csv", text);
  }
  const Dataset dataset = read_dataset(folder.path());
  ASSERT_EQ(dataset.records.size(), 3u);
  for (const DatasetRecord& record : dataset.records) EXPECT_EQ(record.record.n_samples(), 900u);
  EXPECT_EQ(dataset.records[0].split, Split::fit);
  EXPECT_EQ(dataset.records[1].split, Split::fit);
  EXPECT_EQ(dataset.records[2].split, Split::held_out);
  ASSERT_EQ(dataset.guesses.size(), 3u);
  EXPECT_THAT(dataset.guesses[0], ::testing::HasSubstr("rests in its last third"));
  EXPECT_THAT(dataset.guesses[2], ::testing::HasSubstr("held out"));
}

TEST_F(DatasetFolder, TakesWhenThePieceOfALongerRecordBegan) {
  describe(R"({"file": "a.csv", "excitation": "base", "clock_start_s": 120.5})");
  EXPECT_EQ(read_dataset(folder_.path()).records[0].clock_start_s, 120.5);
  expect_refused(R"({"file": "a.csv", "excitation": "base", "clock_start_s": -1})",
                 "/records/0/clock_start_s: must be a time");
  expect_refused(R"({"file": "a.csv", "excitation": "base", "clock_start_s": "late"})",
                 "/records/0/clock_start_s: must be a time");
}

TEST_F(DatasetFolder, RefusesUnknownWordsAndListsTheKnown) {
  expect_refused(R"({"file": "a.csv", "excitation": "shaker"})", "base+wind");
  expect_refused(R"({"file": "a.csv", "excitation": "base", "split": "test"})", "held_out");
  expect_refused(R"({"file": "a.csv", "excitation": "base", "readout": "torque"})", "rotation");
  expect_refused(R"({"file": "a.csv", "excitation": "base", "periods": 3})", "period_samples");
}

TEST_F(DatasetFolder, RefusesBesideTheRecordsWhatWouldHaveMeantSomething) {
  const std::string entry = R"({"file": "a.csv", "excitation": "base"})";
  describe(entry, R"(, "period_samples": 64)");
  expect_error("/period_samples: belongs to each record");
  describe(entry, R"(, "read_out": "rotation")");
  expect_error("did you mean 'readout'?");
  describe(entry, R"(, "comment": "on the stage", "author": "me")");
  EXPECT_EQ(read_dataset(folder_.path()).records.size(), 1u);
}

TEST_F(DatasetFolder, RefusesEntriesOfTheWrongKindAndSaysWhichOne) {
  expect_refused(R"("a.csv")", "/records/0");
  expect_refused(R"({"excitation": "base"})", "name the file");
  expect_refused(R"({"file": "a.csv"})", "excitation");
  expect_refused(R"({"file": "a.csv", "excitation": "base", "period_samples": -4})",
                 "must be a whole number of samples");
  expect_refused(R"({"file": "a.csv", "excitation": "base", "period_samples": 4096})",
                 "longer than the record");
  expect_refused(R"({"file": "a.csv", "excitation": "base", "sampling_rate_hz": "fast"})",
                 "must be a number");
  expect_refused("", "at least one record");
}

TEST_F(DatasetFolder, RefusesARateThatContradictsTheTimes) {
  expect_refused(R"({"file": "a.csv", "excitation": "base", "sampling_rate_hz": 400})", "400");
}

TEST_F(DatasetFolder, RefusesAMissingFile) {
  expect_refused(R"({"file": "c.csv", "excitation": "base"})", "c.csv");
}

TEST_F(DatasetFolder, RefusesAnotherSchemaAndWhatIsNoJson) {
  folder_.file("dataset.json", R"({"schema": "vibrissa-dataset-9", "records": []})");
  expect_error("vibrissa-dataset-1");
  folder_.file("dataset.json", "{\"schema\": ");
  expect_error("not valid JSON");
  folder_.file("dataset.json", "[1, 2]");
  expect_error("vibrissa-dataset-1");
}

TEST_F(DatasetFolder, RefusesARecordWithoutAMoment) {
  std::string text = "time_s,base_acceleration_m_s2\n";
  for (int i = 0; i < 128; ++i) text += std::to_string(0.002 * i) + ",1\n";
  folder_.file("d.csv", text);
  expect_refused(R"({"file": "d.csv", "excitation": "base"})", "base_moment_N_m");
}

TEST(DatasetFolders, AreRefusedWhenEmptyOrMissing) {
  const test::TemporaryFolder empty;
  EXPECT_THROW(read_dataset(empty.path()), UserError);
  EXPECT_THROW(read_dataset(empty.path() / "missing"), UserError);
}

}  // namespace
}  // namespace vibrissa::signals
