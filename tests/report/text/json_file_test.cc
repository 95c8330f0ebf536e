#include "report/text/json_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

using nlohmann::json;
using signals::UserError;
using signals::test::content_of;
using signals::test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(JsonFile, ComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  const json given = {{"a", {1.5, 1e-300, 0.1}},
                      {"b", {{"c", nullptr}, {"d\n\"", "\u00b0"}}},
                      {"e", json::array()},
                      {"f", json::object()},
                      {"g", {json{{"h", 1}}, json{{"h", 2}}}}};
  write_json(folder.path() / "a.json", given);
  EXPECT_EQ(read_json(folder.path() / "a.json"), given);
}

TEST(JsonFile, HoldsNullForANumberThatIsMissingOrNotFinite) {
  EXPECT_EQ(json_or_null(0.25), json(0.25));
  EXPECT_TRUE(json_or_null(std::nullopt).is_null());
  EXPECT_TRUE(json_or_null(std::numeric_limits<double>::infinity()).is_null());
}

TEST(JsonFile, KeepsListsOfNumbersOnOneLine) {
  const TemporaryFolder folder;
  write_json(folder.path() / "a.json",
             {{"w", {json{{"v", 4}}}}, {"x", {1, 2, 3}}, {"y", {{"z", 1}}}});
  EXPECT_EQ(content_of(folder.path() / "a.json"),
            "{\n  \"w\": [\n    {\n      \"v\": 4\n    }\n  ],\n"
            "  \"x\": [1,2,3],\n  \"y\": {\n    \"z\": 1\n  }\n}\n");
}

TEST(JsonFile, RefusesWhatIsNoJsonWithItsPlace) {
  const TemporaryFolder folder;
  const auto file = folder.file("bad.json", "{\n  \"a\": ,\n}");
  EXPECT_THAT([&] { read_json(file); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("bad.json"), HasSubstr("line 2"))));
  EXPECT_THAT([&] { read_json(folder.path() / "none.json"); },
              ThrowsMessage<UserError>(HasSubstr("cannot be opened")));
}

TEST(JsonFile, NamesAMissingOrMistypedEntry) {
  const json object = {{"a", "text"}};
  EXPECT_EQ(required<std::string>(object, "a"), "text");
  EXPECT_EQ(given_or(object, "b", 3.), 3.);
  EXPECT_THAT([&] { required<double>(object, "b"); },
              ThrowsMessage<UserError>(HasSubstr("'b' is missing")));
  EXPECT_THAT([&] { required<double>(object, "a"); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("'a'"), HasSubstr("type"))));
  EXPECT_THAT([&] { given_or(object, "a", 3.); }, ThrowsMessage<UserError>(HasSubstr("'a'")));
  EXPECT_THAT([&] { required<double>(json::array(), "a"); },
              ThrowsMessage<UserError>(HasSubstr("'a' is missing")));
}

}  // namespace
}  // namespace vibrissa::report
