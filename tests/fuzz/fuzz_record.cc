// Any bytes as a text table, with several options: records of finite numbers, or a UserError;
// nothing else.
#include <cmath>
#include <cstdlib>

#include "signals/base/error.h"
#include "signals/files/record_io.h"
#include "tests/fuzz/file_of_bytes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  const fuzz::FileOfBytes file(data, size);
  const signals::ReadOptions all_pieces{.gaps = signals::Gaps::pieces, .takes_all_columns = true};
  signals::ReadOptions even = all_pieces;
  even.resample_hz = 50.;
  for (const signals::ReadOptions& options :
       {signals::ReadOptions{}, signals::ReadOptions{.sampling_rate_hz = 500.}, all_pieces, even}) {
    try {
      for (const auto& record : signals::read_recording(file.path(), options).pieces) {
        if (!(record.sampling_rate_hz() > 0.) || record.n_samples() < 64) std::abort();
        for (const auto& name : record.channel_names())
          for (const double value : record.channel(name))
            if (!std::isfinite(value)) std::abort();
      }
    } catch (const signals::UserError&) {
    }
  }
  return 0;
}
