#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using ::testing::HasSubstr;

// Longer than two of the stream's blocks.
std::string write_long_record(const Folder& folder, const std::size_t gap_at = 0) {
  std::string text = "time_s,base_acceleration_m_s2,base_moment_N_m,hall_mT\n";
  for (std::size_t i = 0; i < 150000; ++i) {
    const double t = static_cast<double>(i + (gap_at != 0 && i >= gap_at ? 1 : 0)) / 1000.;
    const double a = std::sin(40. * t) + 0.3 * std::sin(173. * t);
    text += std::to_string(t) + "," + std::to_string(a) + "," +
            std::to_string(-0.4 * a + 0.1 * std::sin(3. * t)) + ",1\n";
  }
  return folder.write("long.csv", text);
}

TEST(Stream, GivesTheBytesOfTheWholeRecord) {
  const Folder folder;
  const std::string record = quoted(write_long_record(folder));
  const std::string model = folder.file("bvrm.json");
  ASSERT_EQ(vibrissa("identify " + record + " --order 2 -o " + quoted(model) + " --json").status,
            0);
  const std::string common = "separate " + record + " --model " + quoted(model) +
                             " --hold band_limited --method fdaf --method nlms --quiet -o ";
  ASSERT_EQ(vibrissa(common + quoted(folder.file("whole.csv"))).status, 0);
  const ProgramResult streamed = vibrissa(common + quoted(folder.file("stream.csv")) + " --stream");
  ASSERT_EQ(streamed.status, 0) << streamed.errors;
  EXPECT_TRUE(content(folder.file("stream.csv")) == content(folder.file("whole.csv")));
}

TEST(Stream, RefusesAGapBetweenItsBlocksAndLeavesNothing) {
  const Folder folder;
  const std::string record = quoted(write_long_record(folder, 65536));
  const ProgramResult refused =
      vibrissa("separate " + record + " --stream -o " + quoted(folder.file("s.csv")));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("long.csv:65538: time jumps"));
  EXPECT_EQ(folder.n_entries(), 1u);
}

TEST(Stream, RefusesWhatNeedsTheWholeRecord) {
  const Folder folder;
  const std::string record = quoted(write_long_record(folder));
  const ProgramResult truth = vibrissa("separate " + record + " --stream --truth other");
  EXPECT_EQ(truth.status, 2);
  EXPECT_THAT(truth.errors, HasSubstr("--stream holds no record"));
  const ProgramResult mean =
      vibrissa("separate " + record + " --stream -o x.csv --remove-mean " + "base_acceleration");
  EXPECT_EQ(mean.status, 2);
  EXPECT_THAT(mean.errors, HasSubstr("--remove-mean needs the whole record"));
}

TEST(Stream, RefusesFilesAndModelsThatAreWhole) {
  const Folder folder;
  const std::string record = quoted(write_long_record(folder));
  const ProgramResult mat =
      vibrissa("separate " + record + " --stream -o " + quoted(folder.file("s.mat")));
  EXPECT_EQ(mat.status, 2);
  EXPECT_THAT(mat.errors, HasSubstr("--stream writes CSV"));
  const std::string updated = quoted(
      folder.write("updated.json", R"({"schema": "vibrissa-updated-model-1", "effects": []})"));
  const ProgramResult model = vibrissa("separate " + record + " --stream --model " + updated +
                                       " -o " + quoted(folder.file("s.csv")));
  EXPECT_EQ(model.status, 2);
  EXPECT_THAT(model.errors, HasSubstr("an updated model needs the whole record"));
  EXPECT_EQ(folder.n_entries(), 2u);
}

}  // namespace
}  // namespace vibrissa::apps
