#include "diagnosis/model/updated_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "diagnosis/diagnosis.h"
#include "diagnosis/prediction/record_simulation.h"
#include "signals/base/error.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

namespace fs = std::filesystem;
using namespace test;
using testing::HasSubstr;

OneModeRig soft_rig() {
  OneModeRig rig;
  rig.stiffness = 0.8;
  rig.loss = 1.2;
  return rig;
}

UpdatedModel soft_model(bool wind) {
  const Scales scales{.joint_moment_n_m = 1e-3,
                      .duration_s = 4.,
                      .first_mode_rad_s = 220.,
                      .static_gain = 6e-5,
                      .moment_rms_n_m = 3e-4};
  return {nominal_of(OneModeRig{}, wind),
          {{"stiffness", {0.8, 0., 0.5, 1.05, 1., 0.95, 1.}, scales},
           {"damping", {1.2, 0.5, 0.5, 0.4, 0.6}, scales}}};
}

double relative_error(std::span<const double> x, std::span<const double> truth) {
  double error = 0., power = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) {
    error += (x[i] - truth[i]) * (x[i] - truth[i]);
    power += truth[i] * truth[i];
  }
  return std::sqrt(error / power);
}

TEST(SimulateMoment, AgreesWithAnIntegratorThatKnowsTheEffects) {
  const auto fade = [](double t) { return std::min(1., t / 0.5); };
  const auto shaking = sines({7.3, 21.1, 29.7, 44.}, 3., 5);
  const auto a = [&](double t) { return fade(t) * shaking(t); };
  const auto u = [&](double t) { return fade(t) * (2. + std::sin(9. * t)); };
  const signals::Record truth = soft_rig().record(1501, 0., a, u, 1, true);
  const std::vector<double> moment = simulate_moment(soft_model(true), truth);
  ASSERT_EQ(moment.size(), truth.n_samples());
  EXPECT_LT(relative_error(moment, truth.channel(signals::channel::base_moment)), 2e-3);
}

TEST(SimulateMoment, TakesWholePeriodsAsSteadyState) {
  const auto a = sines(odd_lines_hz(500. / 512., 4., 120.), 3., 5);
  const signals::Record truth = soft_rig().record(512, 4.096, a, no_signal, 1, false);
  const auto moment = truth.channel(signals::channel::base_moment);
  EXPECT_LT(relative_error(simulate_moment(soft_model(false), truth, Start::periodic), moment),
            1e-3);
  EXPECT_GT(relative_error(simulate_moment(soft_model(false), truth), moment), 1e-2);
}

TEST(SimulateMoment, AsksForAnInputThatTheModelKnows) {
  signals::Record record(500., 100);
  record.set_channel(signals::channel::wind_speed, std::vector<double>(100, 1.));
  try {
    simulate_moment(soft_model(false), record);
    FAIL();
  } catch (const signals::UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("base_acceleration_m_s2"));
  }
}

class UpdatedModelFile : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  std::string message_of(const std::string& text) const {
    write(text);
    try {
      read_updated_model(file_);
    } catch (const signals::UserError& error) {
      return error.what();
    }
    return "";
  }
  static std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  }
  void TearDown() override { fs::remove(file_); }

  fs::path file_ = fs::temp_directory_path() /
                   (std::string("updated_") +
                    testing::UnitTest::GetInstance()->current_test_info()->name() + ".json");
};

TEST_F(UpdatedModelFile, KeepsEveryFigure) {
  const UpdatedModel model = soft_model(true);
  write(updated_model_json(model));
  EXPECT_TRUE(is_updated_model(file_));
  EXPECT_EQ(updated_model_json(read_updated_model(file_)), updated_model_json(model));
  const signals::Record inputs = OneModeRig{}.record(
      700, 0., sines({11.}, 2., 1), [](double) { return 2.; }, 1, true);
  EXPECT_EQ(simulate_moment(read_updated_model(file_), inputs), simulate_moment(model, inputs));
}

UpdatedModel model_with_paths() {
  UpdatedModel model = soft_model(true);
  const std::size_t n = model.nominal.modes.size();
  const auto exponents = [n](const double first) { return std::vector<double>(n, first); };
  model.nominal.paths["wire_modulus"] = {exponents(0.22), exponents(0.02), exponents(0.01)};
  model.nominal.paths["silicone_modulus"] = {exponents(0.28), exponents(-0.02), exponents(-0.01)};
  model.nominal.drag_curve = {.speed_m_s = {0., 2., 4.}, .factor = {1.4, 1., 0.9}};
  return model;
}

TEST_F(UpdatedModelFile, KeepsWhatAFiniteElementModelTold) {
  const UpdatedModel model = model_with_paths();
  write(updated_model_json(model));
  EXPECT_EQ(updated_model_json(read_updated_model(file_)), updated_model_json(model));
  const signals::Record inputs = OneModeRig{}.record(
      700, 0., sines({11.}, 2., 1), [](double) { return 3.; }, 1, true);
  EXPECT_EQ(simulate_moment(read_updated_model(file_), inputs), simulate_moment(model, inputs));
  EXPECT_NE(simulate_moment(model, inputs), simulate_moment(soft_model(true), inputs));
}

TEST_F(UpdatedModelFile, OfASimulationWithoutBaseMotionIsReadBack) {
  UpdatedModel model = soft_model(true);
  for (KnownEffect& known : model.effects) known.scales.static_gain = 0.;
  write(updated_model_json(model));
  EXPECT_EQ(updated_model_json(read_updated_model(file_)), updated_model_json(model));
}

TEST_F(UpdatedModelFile, RefusesPathsAndCurvesThatDoNotFit) {
  const std::string good = updated_model_json(model_with_paths());
  EXPECT_THAT(message_of(replaced(good, "0.28", "0.28, 0.3")),
              testing::AllOf(HasSubstr("silicone_modulus/frequency"), HasSubstr("each mode")));
  EXPECT_THAT(message_of(replaced(good, "1.4,", "")), HasSubstr("number for each speed"));
  EXPECT_THAT(message_of(replaced(good, "0.0,\n    2.0", "2.0,\n    2.0")),
              HasSubstr("ascending order"));
}

TEST_F(UpdatedModelFile, IsRefusedWithThePlaceOfWhatIsWrong) {
  const std::string good = updated_model_json(soft_model(true));
  EXPECT_THAT(message_of(replaced(good, "\"stiffness\"", "\"stifness\"")),
              testing::AllOf(HasSubstr("/effects/0/id"), HasSubstr("stiffness")));
  EXPECT_THAT(message_of(replaced(good, "0.8", "80")), HasSubstr("/effects/0/parameters/0/value"));
  EXPECT_THAT(message_of(replaced(good, "joint_share\"", "share\"")),
              HasSubstr("/nominal/joint_share is missing"));
  EXPECT_THAT(message_of(replaced(good, "updated-model-1", "updated-model-9")),
              HasSubstr("vibrissa-updated-model-1"));
  EXPECT_EQ(message_of(replaced(good, "updated-model-1", "mended-model-1")), "");  // version 1
  EXPECT_EQ(message_of(replaced(good, "\"higher_joint_share\"", "\"other\"")), "") << "earlier";
  EXPECT_THAT(message_of(replaced(good, "higher_joint_share\": 0.5", "higher_joint_share\": 1.5")),
              HasSubstr("higher_joint_share must be at most 1"));
  EXPECT_THAT(message_of(replaced(good, "220", "-220")), HasSubstr("first_mode_rad_s"));
  EXPECT_FALSE(is_updated_model("/no/such/file"));
}

TEST(UpdatedModel, LeavesNothingToFindWhereItCameFrom) {
  OneModeRig rig = noisy_rig();
  rig.stiffness = 0.8;
  const Diagnosis first = diagnose(nominal_of(rig, false), rig_dataset(rig), {});
  ASSERT_EQ(first.verdict, "stiffness");
  EXPECT_EQ(diagnose(first.updated, rig_dataset(rig, {.seed = 90})).verdict, "none");
  rig.delay_s = 1.5e-3;
  const Diagnosis further = diagnose(first.updated, rig_dataset(rig));
  EXPECT_EQ(further.verdict, "delay");
  ASSERT_FALSE(further.ranking.front().parameters.empty());
  EXPECT_NEAR(further.ranking.front().parameters.front().value, 1.5e-3, 2e-4);
}

}  // namespace
}  // namespace vibrissa::diagnosis
