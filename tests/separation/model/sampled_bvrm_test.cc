#include "separation/model/sampled_bvrm.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

void expect_equal(const Bvrm& a, const Bvrm& b) {
  ASSERT_EQ(a.modes.size(), b.modes.size());
  for (std::size_t k = 0; k < a.modes.size(); ++k) {
    EXPECT_EQ(a.modes[k].b1, b.modes[k].b1);
    EXPECT_EQ(a.modes[k].b0, b.modes[k].b0);
    EXPECT_EQ(a.modes[k].a1, b.modes[k].a1);
    EXPECT_EQ(a.modes[k].a0, b.modes[k].a0);
  }
  EXPECT_EQ(a.direct_term_kg_m, b.direct_term_kg_m);
  EXPECT_EQ(a.delay_s, b.delay_s);
}

TEST(BvrmFile, ReadsBackExactlyWhatWasWritten) {
  Bvrm model = test::sensor(3, 1. / 3.);
  model.delay_s = -0.1 / 3.;
  const auto file = std::filesystem::temp_directory_path() / "vibrissa_bvrm_test.json";
  for (const std::optional<Hold> hold : {std::optional<Hold>(), {Hold::band_limited}}) {
    write_bvrm(file, {model, hold});
    expect_equal(read_bvrm(file).model, model);
    EXPECT_EQ(read_bvrm(file).hold, hold);
  }
  std::filesystem::remove(file);
}

TEST(BvrmFile, KeepsTheVerdictAndWarnsOfAModelThatIsNotUsable) {
  const auto read = [](const SampledBvrm& model) {
    return sampled_bvrm_from_json(to_json(model), "model.json");
  };
  SampledBvrm model{test::sensor(1)};
  EXPECT_FALSE(read(model).verdict);  // as in a file of before
  EXPECT_EQ(read(model).warning(), "");
  model.verdict = {true, "Usable from 1 Hz to 2 Hz."};
  EXPECT_EQ(read(model).verdict->sentence, model.verdict->sentence);
  EXPECT_EQ(read(model).warning(), "");
  model.verdict = {false, "Not usable: the model explains nothing."};
  EXPECT_THAT(read(model).warning(), HasSubstr(model.verdict->sentence));
  nlohmann::json bad = to_json(model);
  bad["usable"] = "no";
  EXPECT_THAT([&] { sampled_bvrm_from_json(bad, "model.json"); },
              ThrowsMessage<UserError>(HasSubstr("model.json: 'usable'")));
}

TEST(BvrmFile, NamesTheFileThatIsMissingOrNoJson) {
  const auto file = std::filesystem::temp_directory_path() / "vibrissa_bvrm_test_bad.json";
  std::filesystem::remove(file);
  EXPECT_THAT([&] { read_bvrm(file); }, ThrowsMessage<UserError>(HasSubstr(file.string())));
  std::ofstream(file) << "{\"schema\": ";
  EXPECT_THAT([&] { read_bvrm(file); }, ThrowsMessage<UserError>(HasSubstr("not valid JSON")));
  std::ofstream(file) << "{\"delay_s\": 1e400}";  // beyond every double
  EXPECT_THAT([&] { read_bvrm(file); }, ThrowsMessage<UserError>(HasSubstr("1e400")));
  std::filesystem::remove(file);
}

TEST(BvrmFile, NamesAHoldThatIsNone) {
  nlohmann::json bad = to_json(SampledBvrm{test::sensor(1), Hold::zero_order});
  const auto read = [&] { sampled_bvrm_from_json(bad, "model.json"); };
  EXPECT_NO_THROW(read());
  bad["hold"] = "straight";
  EXPECT_THAT(read, ThrowsMessage<UserError>(
                        AllOf(HasSubstr("model.json: 'hold'"), HasSubstr("first_order"))));
  bad["hold"] = 1;
  EXPECT_THAT(read, ThrowsMessage<UserError>(HasSubstr("'hold' must be a string")));
}

TEST(SampledBvrm, TakesTheInputAsToldElseAsItWasForTheFit) {
  const SampledBvrm known{test::sensor(1), Hold::band_limited}, unknown{test::sensor(1)};
  EXPECT_EQ(known.hold_or(Hold::zero_order), Hold::zero_order);
  EXPECT_EQ(known.hold_or({}), Hold::band_limited);
  EXPECT_EQ(unknown.hold_or({}), Hold::first_order);
}

}  // namespace
}  // namespace vibrissa::separation
