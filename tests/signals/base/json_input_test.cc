#include "signals/base/json_input.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "signals/base/error.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

std::string nested(const std::size_t n) {
  return std::string(n, '[') + std::string(n, ']');
}

TEST(JsonInput, SaysWhereAFileIsNoJson) {
  const test::TemporaryFolder folder;
  const auto file = folder.file("bad.json", "{\n  \"a\": ,\n}");
  EXPECT_THAT([&] { read_json(file); },
              ThrowsMessage<UserError>(
                  AllOf(HasSubstr("bad.json"), HasSubstr("line 2"), Not(HasSubstr("exception")))));
}

TEST(JsonInput, RefusesWhatWouldExhaustTheStack) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_json(folder.file("shallow.json", nested(60))).size(), 1U);
  for (const std::size_t n : {100UL, 3'000'000UL}) {
    const auto file = folder.file("deep.json", nested(n));
    EXPECT_THAT([&] { read_json(file); }, ThrowsMessage<UserError>(HasSubstr("nested deeper")));
  }
}

}  // namespace
}  // namespace vibrissa::signals
