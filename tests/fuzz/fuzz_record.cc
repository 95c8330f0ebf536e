// Any bytes as a CSV record: a record of finite numbers, or a UserError; nothing else.
#include <cmath>
#include <cstdlib>

#include "signals/base/error.h"
#include "signals/files/record_io.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  const fuzz::FileOfBytes file(data, size);
  for (const std::optional<double> rate_hz : {std::optional<double>(), std::optional(500.)}) {
    try {
      const auto record = signals::read_record(file.path(), {.sampling_rate_hz = rate_hz});
      if (!(record.sampling_rate_hz() > 0.) || record.n_samples() < 64) std::abort();
      for (const auto& name : record.channel_names())
        for (const double value : record.channel(name))
          if (!std::isfinite(value)) std::abort();
    } catch (const signals::UserError&) {
    }
  }
  return 0;
}
