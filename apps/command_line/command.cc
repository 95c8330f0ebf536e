#include "apps/command_line/command.h"

#include <fstream>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

namespace vibrissa::apps {

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_flag("--json", options.json, "Prints the result as JSON on standard output");
  command.add_flag("-q,--quiet", options.quiet,
                   "Prints no progress bar and no remarks; warnings are printed");
}

namespace {

CLI::Validator number_that(const std::string& must, const std::string& type,
                           const std::function<bool(double)>& is_so) {
  const auto check = [=](const std::string& text) -> std::string {
    double value = 0.;
    if (CLI::detail::lexical_cast(text, value) && is_so(value)) return "";
    return "must be " + must + ", not " + text;
  };
  return CLI::Validator(check, type);
}

}  // namespace

CLI::Validator positive_number() {
  return number_that("a positive number", "POSITIVE", [](double value) { return value > 0.; });
}

CLI::Validator not_negative_number() {
  return number_that("a number that is not negative", "NONNEGATIVE",
                     [](double value) { return value >= 0.; });
}

std::vector<std::string> given_command_line() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(in, word, '\0');) words.push_back(word);
  return words;
}

void print_json(const nlohmann::json& document) {
  std::cout << document.dump(2) << std::endl;
}

}  // namespace vibrissa::apps
