// Any bytes as a frequency response in a table or a Universal File: frequencies that rise and
// values for each, or a UserError; nothing else. The first byte chooses the format.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "signals/base/error.h"
#include "signals/files/response_file.h"
#include "tests/fuzz/named_file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  constexpr std::array<const char*, 3> ends{".csv", ".uff", ".npy"};
  if (size == 0) return 0;
  const fuzz::NamedFileOfBytes file(data + 1, size - 1, ends[data[0] % ends.size()]);
  try {
    const signals::FrequencyResponse read = signals::formats::read_response(file.path());
    const auto& f = read.frequency_hz;
    if (f.empty() || read.value.size() != f.size()) std::abort();
    if (std::adjacent_find(f.begin(), f.end(), std::greater_equal<>()) != f.end()) std::abort();
    if (!std::isfinite(f.front()) || !std::isfinite(f.back())) std::abort();
  } catch (const signals::UserError&) {
  }
  return 0;
}
