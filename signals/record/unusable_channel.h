#pragma once

#include <optional>
#include <string>

#include "signals/record/record.h"

namespace vibrissa::signals {

/// A channel from which nothing can be identified and with which nothing can be separated.
struct UnusableChannel {
  bool is_constant = false;  // else it has a value that is not finite
  std::string reason{};      // "is constant at 0", "is not finite at sample 3 (0.006 s)"
};

/// Nothing for a channel that varies and is finite. Throws UserError for a channel that the record
/// does not have. Proven by tests/signals/record/unusable_channel_test.cc.
std::optional<UnusableChannel> unusable_channel(const Record& record, const std::string& name);

}  // namespace vibrissa::signals
