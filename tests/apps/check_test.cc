#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <random>

#include "separation/model/simulation.h"
#include "signals/excitation/band_noise.h"
#include "signals/files/record_io.h"
#include "tests/apps/program.h"
#include "tests/signals/rate.h"

namespace vibrissa::apps {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Band-limited base acceleration and the noisy moment of a sensor with one mode.
signals::Record measured() {
  constexpr std::size_t n = 8000;
  constexpr double rate_hz = signals::test::rate_hz;
  separation::Bvrm model;
  model.modes = {separation::make_modal_term(31.47, 0.027, -9e-6)};
  model.direct_term_kg_m = -2e-7;
  const std::vector<double> a = signals::sample({1., 200., 10., n, 1}, rate_hz);
  auto moment = separation::simulate(model, a, rate_hz);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0., 1e-7);
  for (double& m : moment) m += normal(random);
  signals::Record record(rate_hz, n);
  record.set_channel(signals::channel::base_acceleration, a);
  record.set_channel(signals::channel::base_moment, std::move(moment));
  return record;
}

signals::Record without_motion() {
  signals::Record record = measured();
  record.set_channel(signals::channel::base_acceleration, std::vector<double>(8000, 0.));
  return record;
}

TEST(Check, EndsWithTheTableAndSaysByItsStatusWhetherAllCommandsWork) {
  const Folder folder;
  const std::string good = folder.file("good.csv"), dead = folder.file("dead.csv");
  signals::write_record(good, measured());
  signals::write_record(dead, without_motion());
  const auto result = vibrissa("check '" + good + "'");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("identify  good"));
  EXPECT_THAT(result.output, HasSubstr("diagnose  limited"));
  const auto refused = vibrissa("check '" + dead + "'");
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.output, HasSubstr("identify  no"));
  EXPECT_THAT(refused.errors, HasSubstr("'identify'"));
  EXPECT_EQ(vibrissa("check '" + folder.file("absent.csv") + "'").status, 2);
}

TEST(Check, RefusesWhatIdentifyRefuses) {
  const Folder folder;
  const std::string dead = folder.file("dead.csv");
  signals::write_record(dead, without_motion());
  const json document = vibrissa("check --json '" + dead + "'").json();
  EXPECT_EQ(document["serves"]["identify"]["verdict"], "no");
  const auto identified = vibrissa("identify '" + dead + "'");
  EXPECT_EQ(identified.status, 2);
  EXPECT_THAT(identified.errors, HasSubstr("is constant at 0"));
  EXPECT_THAT(document["serves"]["identify"]["reasons"].dump(), HasSubstr("is constant at 0"));
}

TEST(Check, WritesAPageOnlyWhenAsked) {
  const Folder folder;
  const std::string good = folder.file("good.csv"), out = folder.file("out");
  signals::write_record(good, measured());
  ASSERT_EQ(vibrissa("check '" + good + "'").status, 0);
  EXPECT_EQ(folder.n_entries(), 1u);
  const auto result = vibrissa("check '" + good + "' --out '" + out + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  for (const std::string file : {"/report.html", "/check.json", "/check.txt", "/run.json"})
    EXPECT_TRUE(std::filesystem::exists(out + file)) << file;
  EXPECT_THAT(content(out + "/report.html"), HasSubstr("Coherence of base acceleration"));
  EXPECT_EQ(vibrissa("check '" + good + "' --out '" + out + "'").status, 2);
}

TEST(Check, IdentifyAndSeparateWarnOfClipping) {
  const Folder folder;
  const std::string file = folder.file("clipped.csv");
  signals::Record record = measured();
  const auto a = record.channel(signals::channel::base_acceleration);
  std::vector<double> clipped(a.begin(), a.end());
  for (double& v : clipped) v = std::clamp(v, -4., 4.);
  record.set_channel(signals::channel::base_acceleration, std::move(clipped));
  signals::write_record(file, record);
  for (const std::string command : {"identify", "separate"})
    EXPECT_THAT(vibrissa(command + " '" + file + "' --json").errors, HasSubstr("is clipped"));
}

}  // namespace
}  // namespace vibrissa::apps
