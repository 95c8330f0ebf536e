#include "signals/record/unusable_channel.h"

#include <algorithm>
#include <cmath>

#include "signals/base/is_constant.h"
#include "signals/base/number_text.h"

namespace vibrissa::signals {

std::optional<UnusableChannel> unusable_channel(const Record& record, const std::string& name) {
  const auto x = record.channel(name);
  const auto bad = std::ranges::find_if_not(x, [](double value) { return std::isfinite(value); });
  if (bad != x.end()) {
    const auto i = static_cast<std::size_t>(bad - x.begin());
    return UnusableChannel{.reason = "is not finite at sample " + std::to_string(i) + " (" +
                                     to_text(record.time_s(i)) + " s)"};
  }
  if (!is_constant(x)) return std::nullopt;
  return UnusableChannel{.is_constant = true,
                         .reason = "is constant at " + to_text(x.front() + 0.)};  // no minus zero
}

}  // namespace vibrissa::signals
