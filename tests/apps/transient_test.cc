#include <gmock/gmock.h>

#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <random>

#include "signals/files/record_io.h"
#include "signals/model/reduced_model.h"
#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string coarse_and_short = " --set 'Model/Mesh resolution=1' --duration 0.2";

/// A whisker at 1 g and its resonance, finite strain, 64 samples, a checkpoint at every second one.
const std::string swinging =
    "transient '" + case_file("whisker_sensor.prm") + "'" + coarse_and_short +
    " --set 'Records/Sampling rate=320' --set 'Base motion/Lines=27'"
    " --set 'Base motion/Peak=9.81' --set 'Transient/Checkpoint interval=2'";

/// Starts the program, waits and ends it by a signal; true when that came before its own end.
bool interrupt(const std::string& arguments, const std::function<void()>& wait, const int signal) {
  const std::string command =
      std::string("exec '") + VIBRISSA_PROGRAM + "' " + arguments + " > /dev/null 2>&1";
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  wait();
  kill(child, signal);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) || (WIFEXITED(status) && WEXITSTATUS(status) == 130);
}

std::function<void()> for_seconds(const double time_s) {
  return [=] { usleep(static_cast<useconds_t>(1e6 * time_s)); };
}

/// Waits for the start, which takes a machine-dependent time, at most two minutes.
std::function<void()> until_there(const std::string& file) {
  return [=] {
    constexpr double look_again_s = 0.02;
    constexpr int n_looks = 6000;
    for (int i = 0; i < n_looks && !fs::exists(file); ++i) for_seconds(look_again_s)();
  };
}

TEST(Transient, WritesRecordEnergiesFieldsAndASummary) {
  const Folder folder;
  const auto result = vibrissa(swinging + " --set 'Transient/VTK interval=30' --json -o '" +
                               folder.file("run") + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto summary = result.json();
  EXPECT_EQ(summary["samples"], 64);
  EXPECT_EQ(summary["strain"], "finite");
  EXPECT_LT(summary["two_moment_routes_relative_difference"], 1e-6);
  EXPECT_LT(summary["energy_error_over_largest_work"], 1e-3);
  const auto record = signals::read_record(folder.file("run/record.csv"));
  EXPECT_EQ(record.n_samples(), 64u);
  EXPECT_TRUE(record.has(signals::channel::base_moment));
  EXPECT_TRUE(fs::exists(folder.file("run/energy.csv")));
  EXPECT_TRUE(fs::exists(folder.file("run/vtk/transient.pvd")));
  EXPECT_TRUE(fs::exists(folder.file("run/vtk/transient_1.vtu")));
  EXPECT_FALSE(fs::exists(folder.file("run/checkpoint.h5")));
}

TEST(Transient, SmallStrainIsWhatTheReducedModelSays) {
  const Folder folder;
  const std::string linear = "transient '" + case_file("flow_sensor.prm") + "'" + coarse_and_short +
                             " --set Records/Seed=3 --set Transient/Substeps=20 --strain small";
  ASSERT_EQ(vibrissa(linear + " -o '" + folder.file("run") + "' --quiet").status, 0);
  ASSERT_EQ(vibrissa("simulate '" + case_file("flow_sensor.prm") + "'" + coarse_and_short +
                     " --set Model/Sensitivities=false --quiet --record '" +
                     folder.file("any.csv") + "' --write-model '" + folder.file("model.json") + "'")
                .status,
            0);
  const auto full = signals::read_record(folder.file("run/record.csv"));
  // Both interpolate linearly between the samples.
  const auto reduced =
      signals::simulate(signals::read_reduced_model(folder.file("model.json")),
                        {.sampling_rate_hz = full.sampling_rate_hz(),
                         .n_samples = full.n_samples(),
                         .base_acceleration = full.channel(signals::channel::base_acceleration),
                         .wind_speed = full.channel(signals::channel::wind_speed)});
  const auto x = full.channel(signals::channel::base_moment);
  const auto& y = reduced.base_moment;
  double peak = 0., difference = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) {
    peak = std::max(peak, std::abs(x[i]));
    difference = std::max(difference, std::abs(x[i] - y[i]));
  }
  EXPECT_LT(difference, 5e-3 * peak);
}

TEST(Transient, KilledAgainAndAgainAndResumedLeavesTheSameFiles) {
  const Folder folder;
  const std::string undisturbed = folder.file("undisturbed"), killed = folder.file("killed");
  ASSERT_EQ(vibrissa(swinging + " --quiet -o '" + undisturbed + "'").status, 0);
  const char* wanted = std::getenv("VIBRISSA_KILLS");
  const int n_kills = wanted != nullptr ? std::atoi(wanted) : 4;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> after_s(0.3, 2.);
  int n_killed = 0;
  std::string command = swinging + " --quiet -o '" + killed + "'";
  while (n_killed < n_kills && interrupt(command, for_seconds(after_s(random)), SIGKILL)) {
    ++n_killed;
    if (fs::exists(killed + "/resolved.prm"))
      command = "transient --quiet --resume " + quoted(killed);
  }
  if (!fs::exists(killed + "/summary.json")) {
    const auto last = vibrissa(command);
    ASSERT_EQ(last.status, 0) << last.errors;
  }
  EXPECT_GE(n_killed, 1);
  for (const char* name : {"record.csv", "energy.csv", "summary.json"})
    EXPECT_EQ(content(killed + "/" + name), content(undisturbed + "/" + name)) << name;
  for (const auto& entry : fs::recursive_directory_iterator(killed))
    EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr("unfinished")));
  RecordProperty("kills", n_killed);
}

TEST(Transient, CtrlCWritesACheckpointFirst) {
  const Folder folder;
  const std::string run = folder.file("run");
  ASSERT_TRUE(interrupt(swinging +
                            " --set 'Transient/Checkpoint interval=0' --set 'Transient/VTK "
                            "interval=1' --set Records/Duration=20 --quiet -o '" +
                            run + "'",
                        until_there(run + "/vtk/transient_1.vtu"), SIGINT));
  EXPECT_TRUE(fs::exists(run + "/checkpoint.h5"));
  EXPECT_FALSE(fs::exists(run + "/record.csv"));
}

TEST(Transient, RefusesToGoOnWithWhatIsNoRunOrDoneOrAnotherCase) {
  const Folder folder;
  const auto refusal = [](const std::string& arguments) {
    const auto result = vibrissa("transient " + arguments);
    EXPECT_EQ(result.status, 2);
    return result.errors;
  };
  EXPECT_THAT(refusal("--resume " + quoted(folder.file("absent"))), HasSubstr("holds no run"));
  EXPECT_THAT(refusal(""), HasSubstr("name a case file"));
  const std::string run = folder.file("run");
  ASSERT_TRUE(interrupt(swinging + " --set Records/Duration=20 --quiet -o '" + run + "'",
                        until_there(run + "/checkpoint.h5"), SIGINT));
  EXPECT_THAT(refusal(quoted(case_file("flow_sensor.prm")) + " --resume " + quoted(run)),
              HasSubstr("give no other option"));
  const std::string file = run + "/resolved.prm";
  std::string text = content(file);
  const auto at = text.find("set Spectral radius");
  text.replace(text.find("0.9", at), 3, "0.8");
  std::ofstream(file) << text;
  EXPECT_THAT(refusal("--resume " + quoted(run)),
              testing::AllOf(HasSubstr("checkpoint.h5"), HasSubstr("in 'Transient'"),
                             HasSubstr("0.9"), HasSubstr("0.8")));
}

TEST(Transient, ALoadThatDivergesEndsItWithTheResidualsAndLeavesNoRecord) {
  const Folder folder;
  const std::string run = folder.file("run");
  const auto result =
      vibrissa(swinging + " --set 'Base motion/Peak=1e6' --quiet -o " + quoted(run));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, testing::AllOf(HasSubstr("finds no equilibrium in step"),
                                            HasSubstr("relative out-of-balance force: "),
                                            HasSubstr("Take more substeps or weaker inputs")));
  EXPECT_FALSE(fs::exists(run + "/record.csv"));
  EXPECT_FALSE(fs::exists(run + "/summary.json"));
}

TEST(LongTransient, ChoosesItsSubstepsWhereTheCaseSaysSoAndTellsThem) {
  const Folder folder;
  const std::string adaptive = swinging + " --set 'Transient/Substep choice=adaptive'";
  const auto result =
      vibrissa(adaptive + " --set 'Transient/Most substeps=16' -o " + quoted(folder.file("run")));
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto counts = nlohmann::json::parse(content(folder.file("run/summary.json")))["substeps"];
  EXPECT_GE(counts["smallest"], 1);
  EXPECT_GT(counts["largest"], 1);
  EXPECT_LE(counts["largest"], 16);
  EXPECT_GT(counts["mean"], 1.);
  EXPECT_GE(counts["rejected_intervals"], 1);
  EXPECT_TRUE(counts.contains("intervals_over_tolerance"));
  EXPECT_THAT(result.output, HasSubstr("to " + counts["largest"].dump() + " substeps a sample"));
  const std::string table = content(folder.file("run/substeps.csv"));
  EXPECT_THAT(table, testing::StartsWith("time [s],substeps,rejected_tries,error"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 64);  // 63 intervals
  const auto refusal = [&](const std::string& setting) {
    return vibrissa(adaptive + " --set " + quoted("Transient/" + setting)).errors;
  };
  EXPECT_THAT(refusal("Time tolerance=0"), HasSubstr("Transient/Time tolerance = 0"));
  EXPECT_THAT(refusal("Time tolerance=-1"), HasSubstr("Time tolerance"));
  EXPECT_THAT(refusal("Most substeps=0"), HasSubstr("Most substeps"));
  EXPECT_THAT(refusal("Most substeps=48"), HasSubstr("Transient/Most substeps = 48"));
  EXPECT_THAT(refusal("Strain=small"), HasSubstr("Transient/Substep choice = adaptive needs"));
}

TEST(Transient, WhereNothingMayBeWrittenItIsRefusedAndWhatIsThereStays) {
  const Folder folder;
  const std::string disk = folder.file("disk");
  fs::create_directory(disk);
  if (std::system(
          ("mount -t tmpfs -o size=300k tmpfs " + quoted(disk) + " 2> /dev/null").c_str()) != 0)
    GTEST_SKIP() << "no right to mount a small disk";
  std::ofstream(disk + "/kept.txt") << "kept";
  ASSERT_EQ(std::system(("mount -o remount,ro " + quoted(disk)).c_str()), 0);
  const auto result = vibrissa(swinging + " --quiet -o '" + disk + "/run'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, testing::AllOf(HasSubstr("disk/run"), HasSubstr("Read-only")));
  EXPECT_EQ(content(disk + "/kept.txt"), "kept");
  ASSERT_EQ(std::system(("umount " + quoted(disk)).c_str()), 0);
}

TEST(Transient, AFullDiskEndsItWithTheReasonAndKeepsWhatWasThere) {
  const Folder folder;
  const std::string disk = folder.file("disk");
  fs::create_directory(disk);
  if (std::system(("mount -t tmpfs -o size=300k tmpfs '" + disk + "' 2> /dev/null").c_str()) != 0)
    GTEST_SKIP() << "no right to mount a small disk";
  const auto result = vibrissa(swinging + " --quiet -o '" + disk + "/run'");
  EXPECT_EQ(result.status, 74);
  EXPECT_THAT(result.errors, testing::AllOf(HasSubstr("checkpoint.h5"), HasSubstr("No space")));
  for (const auto& entry : fs::directory_iterator(disk + "/run"))
    EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr("unfinished")));
  ASSERT_EQ(std::system(("mount -o remount,size=20m '" + disk + "'").c_str()), 0);
  const auto resumed = vibrissa("transient --quiet --resume '" + disk + "/run'");
  EXPECT_EQ(resumed.status, 0) << resumed.errors;
  ASSERT_EQ(std::system(("umount '" + disk + "'").c_str()), 0);
}

}  // namespace
}  // namespace vibrissa::apps
