#include "apps/command_line/refused_options.h"

#include "signals/base/error.h"

namespace vibrissa::apps {

void refuse_given(const CLI::App& command, const std::vector<std::string>& options,
                  const std::string& reason) {
  for (const std::string& name : options) {
    const CLI::Option* const option = command.get_option_no_throw(name);
    if (option != nullptr && option->count() > 0)
      throw signals::UserError(name + " " + reason + "; leave it out");
  }
}

const std::vector<std::string>& record_option_names() {
  static const std::vector<std::string> names = {
      "--column", "--rate",     "--rows",      "--remove-mean", "--gaps",        "--join",
      "--align",  "--resample", "--separator", "--decimal",     "--header-lines"};
  return names;
}

}  // namespace vibrissa::apps
