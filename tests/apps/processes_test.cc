#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "report/files/child_process.h"
#include "signals/files/record_io.h"
#include "signals/model/reduced_model.h"
#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double as_alone = 1e-9;
// A hanging job must not hang the tests.
constexpr double time_limit_s = 300.;

/// vibrissa by several processes; without mpirun there is nothing to test.
class Processes : public testing::Test {
 protected:
  void SetUp() override {
    mpirun_ = report::find_program("mpirun");
    if (mpirun_.empty()) GTEST_SKIP() << "no mpirun";
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }
  report::ChildResult together(const std::string& arguments, const int n = 2) const {
    return by_shell("-np " + std::to_string(n) + " " + VIBRISSA_PROGRAM + " " + arguments);
  }
  report::ChildResult by_shell(const std::string& arguments) const {
    return report::run_child(
        {"/bin/sh", "-c",
         "exec " + mpirun_ + " --oversubscribe --mca mpi_yield_when_idle 1 " + arguments},
        time_limit_s);
  }
  static std::size_t times(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
      ++n;
    return n;
  }

  const Folder folder_;

 private:
  std::string mpirun_;
};

const std::string short_and_coarse =
    " --duration 0.2 --set 'Records/Sampling rate=320' --set 'Base motion/Lines=2, 5, 9, 30'"
    " --set 'Model/Mesh resolution=1' --json --quiet";

/// A short record of the whole solid at finite strain.
std::string transient(const Folder& folder, const std::string& name) {
  return "transient '" + case_file("flow_sensor.prm") + "'" + short_and_coarse +
         " --set 'Transient/Checkpoint interval=5' --set 'Transient/VTK interval=10' -o '" +
         folder.file(name) + "'";
}

using LongProcesses = Processes;

TEST_F(LongProcesses, TakeTheSolidThroughARecordAsOneDoes) {
  ASSERT_EQ(vibrissa(transient(folder_, "alone")).status, 0);
  const auto job = together(transient(folder_, "together"));
  ASSERT_TRUE(job.succeeded()) << job.output;
  EXPECT_EQ(times(job.output, "\"samples\""), 1u) << "only the first speaks:\n" << job.output;
  EXPECT_THAT(content(folder_.file("together/vtk/transient.pvd")), HasSubstr("transient_1.pvtu"));
  EXPECT_TRUE(fs::exists(folder_.file("together/vtk/transient_1.pvtu")));

  const auto expected = signals::read_record(folder_.file("alone/record.csv"));
  const auto record = signals::read_record(folder_.file("together/record.csv"));
  const auto m = record.channel(signals::channel::base_moment),
             alone = expected.channel(signals::channel::base_moment);
  ASSERT_EQ(m.size(), alone.size());
  double peak = 0., difference = 0.;
  for (std::size_t i = 0; i < m.size(); ++i) {
    peak = std::max(peak, std::abs(alone[i]));
    difference = std::max(difference, std::abs(m[i] - alone[i]));
  }
  EXPECT_GT(peak, 0.);
  EXPECT_LT(difference, as_alone * peak);
}

TEST_F(Processes, MakeTheModelThatOneMakes) {
  const auto simulation = [&](const std::string& name) {
    return "simulate '" + case_file("flow_sensor.prm") + "'" + short_and_coarse +
           " --set Model/Sensitivities=false --record '" + folder_.file(name + ".csv") +
           "' --write-model '" + folder_.file(name + ".json") + "'";
  };
  ASSERT_EQ(vibrissa(simulation("alone")).status, 0);
  const auto job = together(simulation("together"));
  ASSERT_TRUE(job.succeeded()) << job.output;
  EXPECT_EQ(folder_.n_entries(), 4u);
  const auto model = signals::read_reduced_model(folder_.file("together.json")),
             one = signals::read_reduced_model(folder_.file("alone.json"));
  EXPECT_EQ(model.provenance, one.provenance) << "the mesh has another hash";
  for (std::size_t k = 0; k < one.modes.size(); ++k)
    EXPECT_NEAR(model.modes[k].frequency_hz / one.modes[k].frequency_hz, 1., as_alone) << k;
}

TEST_F(Processes, ListTheModesOnce) {
  const std::string coarse =
      folder_.write("coarse.prm", "subsection Model\n  set Mesh resolution = 1\nend\n");
  const auto job = together("modes '" + coarse + "' --no-convergence --json");
  ASSERT_TRUE(job.succeeded()) << job.output;
  EXPECT_EQ(times(job.output, "\"mass_kg\""), 1u) << job.output;
}

TEST_F(Processes, DoTheMainJob) {
  const std::string out = folder_.file("run");
  const auto job = together("run '" + case_file("flow_sensor.prm") +
                            "' --set 'Model/Mesh resolution=1' --set Model/Sensitivities=false "
                            "--set 'Output/Full-order duration=0.02' --set Output/Pictures=false "
                            "--quiet --output '" +
                            out + "'");
  ASSERT_TRUE(job.succeeded()) << job.output;
  EXPECT_EQ(times(job.output, "Results: "), 1u) << job.output;
  const auto summary = nlohmann::json::parse(content(out + "/summary.json"));
  EXPECT_TRUE(summary.contains("separation"));
  EXPECT_LT(summary["full_order_check"]["two_moment_routes_relative_difference"], 1e-6);
  EXPECT_THAT(content(out + "/vtk/transient.pvd"), HasSubstr("transient_0.pvtu"));
  EXPECT_TRUE(fs::exists(out + "/vtk/mode_1_0.pvtu"));
  EXPECT_THAT(content(out + "/report.html"), HasSubstr("\"title\":\"First mode, "));
}

TEST_F(Processes, SayOnceWhatIsWrongForAll) {
  const auto job = together("modes /nonexistent.prm");
  EXPECT_EQ(job.code, 2) << job.output;
  EXPECT_EQ(times(job.output, "vibrissa: "), 1u) << job.output;
  EXPECT_THAT(job.output, HasSubstr("/nonexistent.prm"));
}

TEST_F(Processes, AreRefusedWorkForOne) {
  const auto job = together("bode '" + case_file("flow_sensor.prm") + "'");
  EXPECT_EQ(job.code, 2) << job.output;
  EXPECT_EQ(times(job.output, "vibrissa: "), 1u) << job.output;
  EXPECT_THAT(job.output, HasSubstr("without mpirun"));
}

// Only the first process finds that it cannot write, while the others wait for it.
TEST_F(Processes, EndWhenTheFirstFails) {
  const std::string out = folder_.file("run");
  fs::create_directories(out);
  folder_.write("run/old.txt", "of an earlier run");
  const auto job =
      together("run '" + case_file("flow_sensor.prm") + "'" + quick + " --output '" + out + "'");
  EXPECT_EQ(job.end, report::ChildResult::End::exited) << job.output;
  EXPECT_EQ(job.code, 2) << job.output;
  EXPECT_EQ(times(job.output, "vibrissa: "), 1u) << job.output;
  EXPECT_THAT(job.output, HasSubstr("not empty"));
}

// The second process gets another case file, which does not exist.
TEST_F(Processes, EndWhenAnotherFails) {
  const std::string program = std::string("-np 1 ") + VIBRISSA_PROGRAM + " modes ";
  const auto job = by_shell(program + case_file("flow_sensor.prm") + " : " + program +
                            folder_.file("missing.prm"));
  EXPECT_EQ(job.end, report::ChildResult::End::exited) << job.output;
  EXPECT_EQ(job.code, 2) << job.output;
  EXPECT_EQ(times(job.output, "vibrissa: "), 1u) << job.output;
  EXPECT_THAT(job.output, HasSubstr("missing.prm"));
}

}  // namespace
}  // namespace vibrissa::apps
