#pragma once

#include <functional>
#include <string>
#include <vector>

#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// Channels in the order in which a record is written: those of docs/records.md first, then the
/// others by name.
std::vector<std::string> channels_in_writing_order(const Record& record);

/// What formats with arrays hold of a record, in this order: sampling_rate_hz and start_s (one
/// number each), time_s, the channels.
void for_each_array(
    const Record& record,
    const std::function<void(const std::string& name, std::span<const double>)>& take);

}  // namespace vibrissa::signals::formats
