#include "apps/command_line/results.h"

#include "signals/system/output_file.h"

namespace vibrissa::apps {

std::filesystem::path free_results_folder(const std::string& name) {
  return signals::free_folder_name(std::filesystem::path("results") / name);
}

std::string given_or_result(const std::optional<std::string>& given, const std::string& name,
                            const std::string& file) {
  if (given) return *given;
  const std::filesystem::path folder = free_results_folder(name);
  signals::make_new_folder(folder);
  return (folder / file).string();
}

}  // namespace vibrissa::apps
