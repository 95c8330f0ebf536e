// Any words as a command line: parsed, or refused with a message; nothing else. No work is done:
// commands are parsed, not called.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "apps/command_line/parse_advice.h"
#include "apps/solid/command_tree.h"
#include "signals/base/error.h"

namespace {

/// More commands than there can be are asked for: all that was said is read, nothing is called.
/// (A callback cannot be taken away, it holds what its options are written to.)
void make_idle(CLI::App& app) {
  constexpr std::size_t never = 1000, at_most = 1;
  app.require_subcommand(never, at_most);
}

/// A word a line.
std::vector<std::string> words_of(const std::uint8_t* data, const std::size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> words{"vibrissa"};
  for (std::string word; std::getline(in, word);) words.push_back(word.substr(0, word.find('\0')));
  return words;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  const std::vector<std::string> words = words_of(data, size);
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  const int argc = static_cast<int>(argv.size());
  argv.push_back(nullptr);
  const std::unique_ptr<CLI::App> app = apps::command_tree();
  make_idle(*app);
  try {
    app->parse(argc, argv.data());
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, errors;
    apps::command_advice(*app, argc, argv.data());
    apps::parse_advice(*app, argc, argv.data());
    app->exit(error, out, errors);
    if (out.str().empty() && errors.str().empty()) std::abort();
  } catch (const signals::UserError&) {
  }
  return 0;
}
