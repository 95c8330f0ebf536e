#include "apps/command.h"

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

namespace vibrissa::apps {

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_flag("--json", options.json, "Print the result as JSON on standard output");
  command.add_flag("-q,--quiet", options.quiet, "No progress bar, no remarks");
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
