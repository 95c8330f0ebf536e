// Any text as a --column: a known channel, a column and a finite scale, or a UserError.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "signals/base/error.h"
#include "signals/files/column_choice.h"
#include "signals/record/channel_name.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa::signals;
  // Most texts name no channel: half of them are given one.
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const std::string& choice : {text, "base_moment=" + text}) {
    try {
      const ColumnChoice taken = parse_column_choice(choice);
      if (taken.column.empty() || full_channel_name(taken.channel) != taken.channel) std::abort();
      if (!std::isfinite(taken.scale) || taken.scale == 0.) std::abort();
    } catch (const UserError&) {
    }
  }
  return 0;
}
