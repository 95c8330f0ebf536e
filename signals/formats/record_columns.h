#pragma once

#include <functional>
#include <string>
#include <vector>

#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// Channels in the order of writing: first the channels of docs/records.md, then the others by
/// name.
std::vector<std::string> channels_in_writing_order(const Record& record);

/// Calls `take` for each array of a record: sampling_rate_hz and start_s (one number each), time_s,
/// the channels.
void for_each_array(
    const Record& record,
    const std::function<void(const std::string& name, std::span<const double>)>& take);

}  // namespace vibrissa::signals::formats
