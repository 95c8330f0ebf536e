#include "signals/system/file_bytes.h"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "signals/base/error.h"
#include "signals/system/output_file.h"

namespace vibrissa::signals {

std::string read_bytes(const std::filesystem::path& file) {
  if (std::error_code ignored; std::filesystem::is_directory(file, ignored))
    throw UserError(file.string() + ": this is a folder, not a file");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream)
    throw UserError(file.string() + ": cannot be read: " + std::generic_category().message(errno));
  return bytes;
}

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  write_file(file, [&](std::ostream& out) {
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  });
}

}  // namespace vibrissa::signals
