#include "signals/files/dataset_response.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "signals/base/error.h"
#include "signals/files/dataset.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::HasSubstr;

struct Line {
  double frequency_hz;
  std::complex<double> value;  // deflection per base acceleration [m / (m/s2)]
};

/// A resonance at 140 Hz with some noise.
std::vector<Line> resonance(const unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> part(0., 1e-9);
  std::vector<Line> out;
  for (double f = 130.; f < 150.; f += 0.25) {
    const double x = f / 140.;
    out.push_back({f, -1.3e-6 / std::complex<double>(1. - x * x, 0.02 * x) +
                          std::complex<double>(part(random), part(random))});
  }
  return out;
}

constexpr double level = 0.98;

double degrees(const std::complex<double> value) {
  return std::arg(value) * 180. / std::numbers::pi;
}

/// Magnitude of the deflection in micrometres at this level, and phase.
std::string amplitudes(const std::vector<Line>& lines, const double turn_deg = 0.) {
  std::string text = "frequency_hz,x_um,phase_deg,a_m_s2\n";
  for (const Line& line : lines)
    text += std::to_string(line.frequency_hz) + "," +
            std::to_string(1e6 * level * std::abs(line.value)) + "," +
            std::to_string(degrees(line.value) + turn_deg) + "," + std::to_string(level) + "\n";
  return text;
}

class ResponseDataset : public ::testing::Test {
 protected:
  static std::string entry(const std::string& file, const std::string& more = "",
                           const std::string& drive = R"("drive": {"level": 0.98})") {
    return R"({"kind": "response", "file": ")" + file + R"(", "response_of": "deflection",
      "values": "amplitude", "columns": {"magnitude": "x_um[um]", "phase": "phase_deg"})" +
           (drive.empty() ? "" : ", " + drive) + (more.empty() ? "" : ", " + more) + "}";
  }
  Dataset read(const std::string& entries) {
    folder_.file("dataset.json",
                 R"({"schema": "vibrissa-dataset-1", "records": [)" + entries + "]}");
    return read_dataset(folder_.path(), {.takes_responses = true});
  }
  DatasetResponse only(const std::string& entries) {
    const Dataset dataset = read(entries);
    EXPECT_EQ(dataset.responses.size(), 1U);
    return dataset.responses.front();
  }
  void expect_refused(const std::string& entries, const std::string& why) {
    try {
      read(entries);
      FAIL() << "was accepted; expected: " << why;
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
      EXPECT_THAT(error.what(), HasSubstr(folder_.path().string()));
    }
  }
  static void expect_resonance(const DatasetResponse& response) {
    const std::vector<Line> expected = resonance();
    ASSERT_EQ(response.value.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(response.frequency_hz[i], expected[i].frequency_hz, 1e-6);
      EXPECT_LT(std::abs(response.value[i] - level * expected[i].value),
                1e-5 * level * std::abs(expected[i].value));
      EXPECT_NEAR(response.level_m_s2[i], level, 1e-12);
    }
  }
  test::TemporaryFolder folder_;
};

TEST_F(ResponseDataset, GivesAmplitudesAtALevel) {
  folder_.file("a.csv", amplitudes(resonance()));
  const DatasetResponse response =
      only(entry("a.csv", R"("direction": "down", "split": "held_out")"));
  expect_resonance(response);
  EXPECT_EQ(response.direction, SweepDirection::down);
  EXPECT_EQ(response.split, Split::held_out);
  EXPECT_EQ(response.quantity, ResponseQuantity::deflection);
  // 1e-9 of each part and per m/s2.
  EXPECT_NEAR(response.standard_deviation[30], level * std::sqrt(2.) * 1e-9, 6e-10);
}

TEST_F(ResponseDataset, TakesTheLevelFromAColumnAndInG) {
  folder_.file("a.csv", amplitudes(resonance()));
  expect_resonance(only(entry("a.csv", "", R"("drive": {"level": "a_m_s2"})")));
  EXPECT_NEAR(only(entry("a.csv", "", R"("drive": {"level": 0.1, "unit": "g"})")).level_m_s2[3],
              0.980665, 1e-9);
}

TEST_F(ResponseDataset, IsTheSameWithAWrappedPhase) {
  folder_.file("a.csv", amplitudes(resonance(), -720.));
  expect_resonance(only(entry("a.csv")));
}

TEST_F(ResponseDataset, IsTheSameInFallingOrder) {
  std::vector<Line> falling = resonance();
  std::ranges::reverse(falling);
  folder_.file("a.csv", amplitudes(falling));
  expect_resonance(only(entry("a.csv", "", R"("drive": {"level": "a_m_s2"})")));
}

TEST_F(ResponseDataset, IsTheSameInDecibelsAndPerDrive) {
  std::string text = "frequency_hz,magnitude_dB,phase_deg\n";
  for (const Line& line : resonance()) {
    char row[96];
    std::snprintf(row, sizeof row, "%.9g,%.9g,%.9g\n", line.frequency_hz,
                  20. * std::log10(std::abs(line.value)), degrees(line.value));
    text += row;
  }
  folder_.file("a.csv", text);
  expect_resonance(only(
      R"({"kind": "response", "file": "a.csv", "response_of": "deflection", "drive": {"level": 0.98}})"));
}

TEST_F(ResponseDataset, IsTheSameWhereAConjugatedPhaseIsDeclared) {
  std::vector<Line> lines = resonance();
  for (Line& line : lines) line.value = std::conj(line.value);
  folder_.file("a.csv", amplitudes(lines));
  expect_refused(entry("a.csv"), "the phase rises through the resonance");
  expect_resonance(only(entry("a.csv", R"("phase": "conjugated")")));
}

TEST_F(ResponseDataset, OfAnUnknownOffsetIsMarked) {
  folder_.file("a.csv", amplitudes(resonance(), 77.));
  EXPECT_FALSE(only(entry("a.csv", R"("phase": "unknown_offset")")).phase_offset_is_known);
}

TEST_F(ResponseDataset, WithoutALevelIsRefused) {
  folder_.file("a.csv", amplitudes(resonance()));
  expect_refused(entry("a.csv", "", ""), "/records/0/drive: the level is missing");
  expect_refused(entry("a.csv", "", R"("drive": {"unit": "g"})"), "the level is missing");
  expect_refused(entry("a.csv", "", R"("drive": {"level": 0})"), "must be above 0");
  expect_refused(entry("a.csv", "", R"("drive": {"level": "b"})"), "no column 'b'");
  expect_refused(entry("a.csv", "", R"("drive": {"level": 1, "unit": "N"})"),
                 "the drive is the amplitude of the base acceleration");
}

TEST_F(ResponseDataset, WithNegativeMagnitudesIsRefused) {
  std::vector<Line> lines = resonance();
  std::string text = amplitudes(lines);
  text.replace(text.find(",", text.find("\n")), 1, ",-");
  folder_.file("a.csv", text);
  expect_refused(entry("a.csv"), "where it is in decibels, name it ..._dB");
}

TEST_F(ResponseDataset, OfBothDirectionsOrUnsortedIsRefused) {
  std::vector<Line> both = resonance(), unsorted = resonance();
  for (std::size_t i = both.size(); i-- > 0;) both.push_back(both[i]);
  folder_.file("a.csv", amplitudes(both));
  expect_refused(entry("a.csv"), "mixes an upward and a downward sweep");
  std::swap(unsorted[10], unsorted[11]);
  folder_.file("a.csv", amplitudes(unsorted));
  expect_refused(entry("a.csv"), "is out of order");
}

TEST_F(ResponseDataset, OfALevelThatIsNamedTwiceIsRefusedUnlessRepeated) {
  folder_.file("a.csv", amplitudes(resonance()));
  folder_.file("b.csv", amplitudes(resonance(2)));
  expect_refused(entry("a.csv") + "," + entry("b.csv"),
                 "the responses 'a' and 'b' have the same level, 0.98 m/s2, and direction");
  EXPECT_EQ(read(entry("a.csv") + "," + entry("b.csv", R"("direction": "down")")).responses.size(),
            2U);
  const Dataset repeated =
      read(entry("a.csv", R"("repeat": 1)") + "," + entry("b.csv", R"("repeat": 2)"));
  EXPECT_EQ(repeated.responses[0].standard_deviation, repeated.responses[1].standard_deviation);
}

TEST_F(ResponseDataset, WithUnknownWordsIsRefused) {
  folder_.file("a.csv", amplitudes(resonance()));
  expect_refused(R"({"kind": "sweep", "file": "a.csv"})", "Known: record, response");
  expect_refused(entry("a.csv", R"("direction": "upwards")"), "Known: up, down");
  expect_refused(entry("a.csv", R"("levle": 1)"), "unknown entry 'levle'");
  expect_refused(R"({"kind": "response", "file": "a.csv", "response_of": "strain"})",
                 "Known: moment, rotation, deflection, velocity, acceleration");
}

TEST_F(ResponseDataset, FindsColumnsByTheNamesThatTheFileHas) {
  for (const auto& [in_file, name] : {std::pair<std::string, std::string>{"v[m/s]", "v[m/s]"},
                                      {"v[m/s]", "v"},
                                      {"v[raw]", "v[raw]"},
                                      {"v*2", "v*2"}}) {
    std::string text = amplitudes(resonance());
    text.replace(text.find("x_um"), 4, in_file);
    folder_.file("a.csv", text);
    const DatasetResponse response =
        only(R"({"kind": "response", "file": "a.csv", "response_of": "velocity",
      "values": "amplitude", "columns": {"magnitude": ")" +
             name + R"(", "phase": "phase_deg"}, "drive": {"level": 0.98}})");
    const double expected = 1e6 * level * std::abs(resonance()[5].value);  // as it is printed
    EXPECT_NEAR(std::abs(response.value.at(5)), expected, 1e-5 * expected) << name;
  }
}

TEST_F(ResponseDataset, IsRefusedByThoseWhoDoNotUseResponses) {
  folder_.file("a.csv", amplitudes(resonance()));
  read(entry("a.csv"));
  EXPECT_THAT([&] { read_dataset(folder_.path()); },
              ::testing::ThrowsMessage<UserError>(HasSubstr("/records/0: is a response")));
}

/// Six levels and both directions of a beam on a shaker, as they were published.
TEST_F(ResponseDataset, OfThePublishedBeamHardens) {
  const std::filesystem::path beam = std::filesystem::path(VIBRISSA_SOURCE_DIR).parent_path() /
                                     "shared/real/clamped_beam_stepped_sine";
  if (!std::filesystem::exists(beam)) GTEST_SKIP() << beam << " is missing";
  std::string entries;
  for (const std::string g : {"0.04", "0.06", "0.08", "0.10", "0.12", "0.14"}) {
    const std::string file = "clamped_clamped_no_piezo_no_magnet_24oC_" + g + "g.csv";
    std::filesystem::copy_file(beam / file, folder_.path() / file);
    for (const std::string pass : {"1", "2"})
      entries += (entries.empty() ? "" : ",") + std::string(R"({"kind": "response", "file": ")") +
                 file + R"(", "response_of": "velocity", "values": "amplitude", "direction": ")" +
                 (pass == "1" ? "up" : "down") + R"(", "phase": "conjugated_unknown_offset",
                 "columns": {"magnitude": "velocity_)" +
                 pass + R"(_m_s", "phase": "phase_)" + pass + R"(_deg"}, "drive": {"level": )" + g +
                 R"(, "unit": "g"}})";
  }
  const Dataset dataset = read(entries);
  ASSERT_EQ(dataset.responses.size(), 12U);
  // The jumps of README.md: upwards at 188.8 Hz and downwards at 145.2 Hz for 0.10 g.
  for (const auto& [index, jump_hz] : {std::pair{6U, 188.8}, std::pair{7U, 145.2}}) {
    const DatasetResponse& response = dataset.responses[index];
    std::size_t steepest = 1;
    for (std::size_t i = 1; i < response.value.size(); ++i) {
      const auto step = [&](const std::size_t j) {
        return std::abs(std::abs(response.value[j]) - std::abs(response.value[j - 1]));
      };
      if (step(i) > step(steepest)) steepest = i;
    }
    EXPECT_NEAR(response.frequency_hz[steepest], jump_hz, 0.5);
    EXPECT_GT(std::abs(response.value[steepest - 1]), 5. * response.standard_deviation[steepest]);
  }
}

}  // namespace
}  // namespace vibrissa::signals
