#include "report/files/run_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/text/json_file.h"
#include "signals/base/revision.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

using signals::UserError;
using signals::test::content_of;
using signals::test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::ThrowsMessage;

TEST(RunFolder, RefusesToWriteOverAnEarlierRun) {
  const TemporaryFolder base;
  const RunFolder first(base.path() / "run");
  first.write_text("result.csv", "1\n");
  EXPECT_THAT([&] { RunFolder second(base.path() / "run"); },
              ThrowsMessage<UserError>(HasSubstr("not empty")));
  EXPECT_EQ(content_of(base.path() / "run" / "result.csv"), "1\n");
}

TEST(RunFolder, IsRefusedBeforeTheWorkAsAfterIt) {
  const TemporaryFolder base;
  EXPECT_NO_THROW(RunFolder::refuse_taken(std::nullopt));
  EXPECT_NO_THROW(RunFolder::refuse_taken(base.path() / "new"));
  EXPECT_FALSE(std::filesystem::exists(base.path() / "new"));
  base.file("there.txt", "");
  EXPECT_THAT([&] { RunFolder::refuse_taken(base.path()); },
              ThrowsMessage<UserError>(HasSubstr("not overwritten")));
}

TEST(RunFolder, FindsAFreeName) {
  const TemporaryFolder base;
  EXPECT_EQ(RunFolder::first_free(base.path() / "run").path(), base.path() / "run");
  EXPECT_EQ(RunFolder::first_free(base.path() / "run").path(), base.path() / "run-2");
}

TEST(RunFolder, IsTheGivenOneOrElseTheFirstFree) {
  const TemporaryFolder base;
  EXPECT_EQ(RunFolder::given_or_free(base.path() / "mine", base.path() / "run").path(),
            base.path() / "mine");
  for (const std::string name : {"run", "run-2"})
    EXPECT_EQ(RunFolder::given_or_free(std::nullopt, base.path() / "run").path(),
              base.path() / name);
}

TEST(RunFolder, MakesSubFolders) {
  const TemporaryFolder base;
  const RunFolder run(base.path() / "run");
  run.write_json("a/b/c.json", {{"x", 1}});
  EXPECT_EQ(read_json(base.path() / "run/a/b/c.json")["x"], 1);
}

TEST(RunFolder, RefusesNamesThatLeadOutOfIt) {
  const TemporaryFolder base;
  const RunFolder run(base.path() / "run");
  for (const std::string name : {"", ".", "a/", "../x", "a/../../x", "/tmp/x"})
    EXPECT_THAT([&] { run.file(name); }, ThrowsMessage<UserError>(HasSubstr("is not a file name")))
        << name;
  EXPECT_NO_THROW(run.file("a/../b"));
}

TEST(RunFolder, SaysHowTheRunCameAbout) {
  const TemporaryFolder base;
  const RunFolder run(base.path() / "run");
  run.write_run({.command_line = {"/some/where/bin/vibrissa", "run", "cases/flow.prm"},
                 .seed = 18446744073709551615u,
                 .facts = {{"mesh_sha256", "abc"}}});
  const auto json = read_json(run.file("run.json"));
  EXPECT_EQ(json["program"], "vibrissa");
  EXPECT_EQ(json["version"], signals::program_version());
  EXPECT_EQ(json["revision"], signals::program_revision());
  EXPECT_EQ(json["command_line"], (nlohmann::json{"vibrissa", "run", "cases/flow.prm"}));
  EXPECT_EQ(json["seed"], 18446744073709551615u);
  EXPECT_EQ(json["facts"]["mesh_sha256"], "abc");
  EXPECT_THAT(json["started_utc"].get<std::string>(),
              MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z"));
}

TEST(RunFolder, SaysNullForNoSeed) {
  const TemporaryFolder base;
  const RunFolder run(base.path() / "run");
  run.write_run({});
  EXPECT_TRUE(read_json(run.file("run.json"))["seed"].is_null());
}

TEST(Revision, IsKnownOrSaysThatItIsNot) {
  EXPECT_THAT(signals::program_revision(), MatchesRegex("[A-Za-z0-9._-]+"));
  EXPECT_THAT(signals::program_version(), MatchesRegex("unknown|[0-9]+([.][0-9]+)*"));
}

}  // namespace
}  // namespace vibrissa::report
