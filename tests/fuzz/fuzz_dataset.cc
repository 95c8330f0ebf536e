// Any bytes as dataset.json beside a sound record: records, or a UserError.
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "signals/base/error.h"
#include "signals/files/dataset.h"

namespace {

std::filesystem::path make_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "vibrissa-fuzz-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) std::abort();
  std::ofstream record(name + "/r.csv");
  record << "time_s,base_acceleration_m_s2,base_moment_N_m\n";
  for (int i = 0; i < 80; ++i) record << 2 * i << "e-3," << i % 3 << "," << i % 5 << "\n";
  return name;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = make_folder();
  std::ofstream(folder / "dataset.json", std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    if (vibrissa::signals::read_dataset(folder).records.empty()) std::abort();
  } catch (const vibrissa::signals::UserError&) {
  }
  return 0;
}
