#include "signals/formats/record_columns.h"

#include <algorithm>

#include "signals/record/channel_name.h"

namespace vibrissa::signals::formats {

std::vector<std::string> channels_in_writing_order(const Record& record) {
  // The less usual known channels are sorted among the others, as in existing files.
  const std::vector<std::string> leading = {channel::base_acceleration, channel::cross_acceleration,
                                            channel::wind_speed, channel::base_moment};
  std::vector<std::string> names;
  for (const std::string& name : leading)
    if (record.has(name)) names.push_back(name);
  for (const std::string& name : record.channel_names())
    if (std::find(leading.begin(), leading.end(), name) == leading.end()) names.push_back(name);
  return names;
}

void for_each_array(
    const Record& record,
    const std::function<void(const std::string& name, std::span<const double>)>& take) {
  const double rate = record.sampling_rate_hz(), start = record.time_s(0);
  take("sampling_rate_hz", {&rate, 1});
  take("start_s", {&start, 1});
  std::vector<double> times(record.n_samples());
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = record.time_s(i);
  take(time_channel, times);
  for (const std::string& name : channels_in_writing_order(record))
    take(name, record.channel(name));
}

}  // namespace vibrissa::signals::formats
