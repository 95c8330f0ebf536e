#include "apps/jobs/trial_programs.h"

#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <system_error>

#include "signals/base/error.h"

namespace vibrissa::apps {
namespace fs = std::filesystem;

fs::path trial_program(const std::string& name) {
  const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& folder : {here, here.parent_path() / "libexec" / "vibrissa"})
    if (fs::exists(folder / name)) return folder / name;
  throw signals::UserError(name + " is neither in " + here.string() +
                           " nor in libexec/vibrissa beside it: build the target " + name +
                           ", or install the package again");
}

void become_trial_program(const std::string& name, const std::vector<std::string>& arguments) {
  const std::string program = trial_program(name).string();
  std::vector<char*> words{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  std::cout.flush();
  ::execv(program.c_str(), words.data());
  throw std::system_error(errno, std::generic_category(), program);
}

}  // namespace vibrissa::apps
