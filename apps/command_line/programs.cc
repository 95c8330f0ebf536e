#include "apps/command_line/programs.h"

#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <system_error>

#include "signals/base/error.h"

namespace vibrissa::apps {
namespace fs = std::filesystem;

fs::path program_beside(const std::string& name) {
  const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& folder : {here, here.parent_path() / "libexec" / "vibrissa"})
    if (fs::exists(folder / name)) return folder / name;
  throw signals::UserError(name + " is neither in " + here.string() +
                           " nor in libexec/vibrissa beside it: build the target " + name +
                           ", or install the package again");
}

void become_program(const std::string& name, const std::vector<std::string>& words) {
  const std::string program = program_beside(name).string();
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  std::cout.flush();
  ::execv(program.c_str(), pointers.data());
  throw std::system_error(errno, std::generic_category(), program);
}

report::PictureReport draw_pictures(const fs::path& folder) {
  return report::draw_pictures(folder, {.program = program_beside(solid_program)});
}

}  // namespace vibrissa::apps
