#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(ExitStatus, OfAnUnknownCommandIsBadInputWithAndWithoutHelp) {
  for (const std::string arguments : {"separat", "separat --help", "trial mak --help"}) {
    const auto result = vibrissa(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.errors, HasSubstr("unknown command")) << arguments;
    EXPECT_THAT(result.errors, HasSubstr("did you mean")) << arguments;
    EXPECT_THAT(result.output, IsEmpty()) << arguments;
  }
}

TEST(ExitStatus, OfHelpIsZero) {
  for (const std::string arguments : {"--help", "separate --help", "trial make --help"})
    EXPECT_EQ(vibrissa(arguments).status, 0) << arguments;
}

TEST(ExitStatus, OfAFolderThatIsNotThereIsBadInput) {
  const Folder folder;
  const auto result = vibrissa("init '" + folder.file("none/sensor.prm") + "'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("No such file or directory"));
}

}  // namespace
}  // namespace vibrissa::apps
