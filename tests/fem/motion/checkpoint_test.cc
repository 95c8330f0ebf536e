#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/motion/checkpoint.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "fem/motion/linear_transient.h"
#include "fem/motion/nonlinear_transient.h"
#include "signals/base/error.h"
#include "tests/fem/file_content.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

using testing::HasSubstr;

enum class Model { small, finite, adaptive };

class Checkpoint : public testing::TestWithParam<Model> {
 protected:
  Checkpoint() {
    std::string name =
        (std::filesystem::temp_directory_path() / "vibrissa_checkpoint_XXXXXX").string();
    folder = mkdtemp(name.data());
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = 40. * std::sin(0.2 * i);
  }
  ~Checkpoint() override { std::filesystem::remove_all(folder); }

  TransientRun begin() const {
    return {drive({1000., a.size(), a, {}, wind}), a.size(),
            sensor.parameters().model.axial_direction(), true};
  }
  std::unique_ptr<DrivenSensor> drive(const TransientInput& input) const {
    if (GetParam() == Model::small) return drive_linear(sensor, input, {0.9, 2, true});
    NonlinearOptions options{0.9, 2, true, {0., 0., -9.81}, {}};
    if (GetParam() == Model::adaptive) options.adaptive = SubstepOptions{1.5e-3, 1e-4, 16};
    return drive_nonlinear(sensor, input, options);
  }
  static void go_to(const std::size_t sample, TransientRun& run) {
    while (run.n_done() <= sample) run.advance();
  }
  std::filesystem::path write(const std::size_t sample) const {
    TransientRun run = begin();
    go_to(sample, run);
    write_checkpoint(folder / "checkpoint.h5", run, owner);
    return folder / "checkpoint.h5";
  }
  void expect_refusal(const std::filesystem::path& file, const CheckpointOwner& reader,
                      const std::string& reason) const {
    TransientRun run = begin();
    EXPECT_THAT([&] { read_checkpoint(file, reader, run); },
                testing::ThrowsMessage<signals::UserError>(HasSubstr(reason)));
    EXPECT_EQ(run.n_done(), 1u);
  }

  static SensorParameters relaxing_whisker() {
    SensorParameters parameters = whisker_sensor(1);
    parameters.materials.silicone.relaxation = materials::PronySeries({{0.4, 5e-3}});
    return parameters;
  }
  const Sensor sensor{relaxing_whisker()};
  std::vector<double> a = std::vector<double>(16), wind = std::vector<double>(16, 1.5);
  const CheckpointOwner owner{"subsection Records\n  set Seed = 1\nend\n", {{"mesh", "m"}}, "r7"};
  std::filesystem::path folder;
};
std::string name_of(const testing::TestParamInfo<Model>& info) {
  constexpr std::array names{"Small", "Finite", "Adaptive"};
  return names.at(static_cast<std::size_t>(info.param));
}
INSTANTIATE_TEST_SUITE_P(Strains, Checkpoint,
                         testing::Values(Model::small, Model::finite, Model::adaptive), name_of);

std::vector<std::array<double, 3>> rows_of(const std::vector<IntervalSteps>& intervals) {
  std::vector<std::array<double, 3>> rows;
  for (const auto& i : intervals)
    rows.push_back({static_cast<double>(i.substeps), static_cast<double>(i.n_rejected), i.error});
  return rows;
}

TEST_P(Checkpoint, ARunThatGoesOnFromOneLeavesTheSameRecordBitForBit) {
  TransientRun undisturbed = begin();
  go_to(15, undisturbed);
  const auto intervals = rows_of(undisturbed.output().intervals);
  if (GetParam() == Model::adaptive) {
    ASSERT_NE(intervals.front()[0], intervals.back()[0]) << "nothing to be adapted";
  }
  for (const std::size_t sample : {0u, 1u, 9u}) {
    TransientRun resumed = begin();
    EXPECT_EQ(read_checkpoint(write(sample), owner, resumed), "r7");
    EXPECT_EQ(resumed.n_done(), sample + 1);
    go_to(15, resumed);
    EXPECT_EQ(resumed.output().base_moment, undisturbed.output().base_moment);
    EXPECT_EQ(resumed.output().cross_moment, undisturbed.output().cross_moment);
    EXPECT_EQ(resumed.output().largest_difference, undisturbed.output().largest_difference);
    EXPECT_EQ(resumed.output().count.n_iterations, undisturbed.output().count.n_iterations);
    EXPECT_EQ(rows_of(resumed.output().intervals), intervals);
    if (GetParam() != Model::small) {
      EXPECT_EQ(resumed.output().energy.back().work_j, undisturbed.output().energy.back().work_j);
      EXPECT_EQ(resumed.output().energy.back().numerical_j,
                undisturbed.output().energy.back().numerical_j);
    }
  }
}

TEST_P(Checkpoint, AnotherRunsIsRefusedWithTheFirstEntryThatDiffers) {
  const auto file = write(1);
  CheckpointOwner other = owner;
  other.case_text = "subsection Records\n  set Seed = 2\nend\n";
  expect_refusal(file, other,
                 "in 'Records' it has 'set Seed = 1', but this run has 'set Seed = 2'");
  other = owner;
  other.digests["mesh"] = "n";
  expect_refusal(file, other, "its mesh differs");
}

TEST_P(Checkpoint, OneThatIsDamagedCutOffMissingOrOfAnotherKindIsRefused) {
  const auto file = write(1);
  const std::string whole = content(file);
  const auto write_as = [&](const std::string& bytes) {
    std::ofstream(folder / "other.h5", std::ios::binary) << bytes;
    return folder / "other.h5";
  };
  for (const std::size_t place : {600u, 3000u, 90000u}) {
    std::string flipped = whole;
    ASSERT_LT(place, flipped.size());
    flipped[place] = static_cast<char>(flipped[place] ^ 4);
    expect_refusal(write_as(flipped), owner, "is damaged");
  }
  expect_refusal(write_as(whole.substr(0, whole.size() / 2)), owner, "is damaged");
  expect_refusal(write_as(whole.substr(0, 100)), owner, "is damaged");
  expect_refusal(write_as("time_s,base_moment_N_m\n0,1\n"), owner, "is not a checkpoint");
  expect_refusal(write_as(""), owner, "is not a checkpoint");
  expect_refusal(folder / "absent.h5", owner, "there is no checkpoint");
  expect_refusal(folder, owner, "there is no checkpoint");
}

}  // namespace
}  // namespace vibrissa::fem
