// Any bytes as the text tables of two devices, cut at the middle: joined recordings of finite
// numbers, or a UserError; nothing else.
#include <cmath>
#include <cstdlib>

#include "signals/base/error.h"
#include "signals/files/joined_recording.h"
#include "tests/fuzz/file_of_bytes.h"

namespace {

using namespace vibrissa;

void check(const signals::Recording& both) {
  for (const auto& record : both.pieces)
    for (const auto& name : record.channel_names())
      for (const double value : record.channel(name))
        if (!std::isfinite(value)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::FileOfBytes first(data, size / 2), second(data + size / 2, size - size / 2);
  const signals::ReadOptions options{
      .gaps = signals::Gaps::pieces, .skips_missing_columns = true, .takes_all_columns = true};
  try {
    const auto one = signals::read_recording(first.path(), options);
    const auto other = signals::read_recording(second.path(), options);
    if (const auto shared = signals::shared_channel(one, other))
      check(signals::joined(
          one, other,
          signals::clocks_of(one, *shared, other, *shared, signals::SharedMotion::quantity)));
    else
      check(signals::joined(one, other));
  } catch (const signals::UserError&) {
  }
  return 0;
}
