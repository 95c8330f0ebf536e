#include "apps/command_line/help_formatter.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <memory>

namespace vibrissa::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(HelpFormatter, SaysTypesAndLimitsInWords) {
  CLI::App app;
  app.formatter(std::make_shared<HelpFormatter>());
  auto* command = app.add_subcommand("work", "Works");
  double share = 0.01, time_s = 3.;
  std::size_t n = 0;
  std::string kind = "flow";
  std::vector<std::string> columns;
  command->add_option("--share", share, "s")->check(CLI::Range(1e-4, 0.3))->capture_default_str();
  command->add_option("--time", time_s, "t")->check(CLI::PositiveNumber);
  command->add_option("-n", n, "n")->check(CLI::NonNegativeNumber)->required();
  command->add_option("--kind", kind, "k")->check(CLI::IsMember({"flow", "whisker"}));
  command->add_option("--column", columns, "c");
  const std::string help = command->help();
  EXPECT_THAT(help, HasSubstr("--share NUMBER (0.0001 to 0.3, default 0.01)"));
  EXPECT_THAT(help, HasSubstr("--time NUMBER (above 0)"));
  EXPECT_THAT(help, HasSubstr("-n COUNT (0 or more) (required)"));
  EXPECT_THAT(help, HasSubstr("--kind TEXT (flow or whisker)"));
  EXPECT_THAT(help, HasSubstr("--column TEXT ..."));
  EXPECT_THAT(help, Not(HasSubstr("FLOAT")));
}

}  // namespace
}  // namespace vibrissa::apps
