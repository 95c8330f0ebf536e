#pragma once

#include <CLI/CLI.hpp>

namespace vibrissa::apps {

/// Option types in words: "NUMBER (0.1 to 3, default 1)" in place of "FLOAT:FLOAT in [0.1 - 3]=1".
/// Proven by tests/apps/help_formatter_test.cc.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override;
};

}  // namespace vibrissa::apps
