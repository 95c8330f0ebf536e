#include "report/text/file_name.h"

#include <algorithm>
#include <system_error>

#include "signals/base/error.h"
#include "signals/system/output_file.h"

namespace vibrissa::report {

void check_file_name(const std::string& kind, const std::string& name) {
  const auto is_plain = [](const char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (name.empty() || name.front() == '.' || name.ends_with(".scene") ||
      !std::all_of(name.begin(), name.end(), is_plain))
    throw signals::UserError(kind + " name '" + name +
                             "' is not a plain file name: use letters, digits, '_', '-' and '.'");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) signals::refuse_path(folder, "cannot be made", error);
}

}  // namespace vibrissa::report
