#include "signals/record/record.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/record/channel_name.h"

namespace vibrissa::signals {
namespace {

std::string column_hint(const std::string& name) {
  const std::string channel = full_channel_name(name);
  if (channel.empty()) return "";
  const std::string short_name =
      channel.substr(0, channel.size() - unit_at_the_end(channel).size() - 1);
  return "; say which column is " + short_name + ", as in --column '" + short_name + "=NAME[unit]'";
}

}  // namespace

Record::Record(const double sampling_rate_hz, const std::size_t n_samples, const double start_s)
    : sampling_rate_hz_(sampling_rate_hz), n_samples_(n_samples), start_s_(start_s) {
  assert(std::isfinite(start_s));
  if (!(std::isfinite(sampling_rate_hz) && sampling_rate_hz > 0.))
    throw UserError("the sampling rate must be a positive number of Hz, not " +
                    to_text(sampling_rate_hz));
  if (n_samples == 0) throw UserError("a record needs at least one sample");
}

std::span<const double> Record::channel(const std::string& name) const {
  const auto found = channels_.find(name);
  if (found == channels_.end())
    throw UserError(unknown_name("channel", name, channel_names()) + column_hint(name));
  return found->second;
}

void Record::set_channel(const std::string& name, std::vector<double> values) {
  assert(!name.empty() && name != "time_s");
  if (values.size() != n_samples_)
    throw UserError("channel '" + name + "' has " + std::to_string(values.size()) +
                    " samples, but its record has " + std::to_string(n_samples_));
  channels_.insert_or_assign(name, std::move(values));
}

std::vector<std::string> Record::channel_names() const {
  std::vector<std::string> names;
  names.reserve(channels_.size());
  for (const auto& [name, values] : channels_) names.push_back(name);
  return names;
}

Record Record::slice(const std::size_t first, const std::size_t count) const {
  if (count == 0 || first >= n_samples_ || count > n_samples_ - first)
    throw UserError("a slice of " + std::to_string(count) + " samples from sample " +
                    std::to_string(first) + " on does not fit into a record of " +
                    std::to_string(n_samples_) + " samples");
  Record part(sampling_rate_hz_, count, time_s(first));
  for (const auto& [name, values] : channels_) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    part.channels_.emplace(name,
                           std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count)));
  }
  return part;
}

}  // namespace vibrissa::signals
