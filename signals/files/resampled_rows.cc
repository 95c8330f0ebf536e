#include "signals/files/resampled_rows.h"

#include <span>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/significant_digits.h"
#include "signals/files/record_rows.h"
#include "signals/spectra/uneven_resample.h"

namespace vibrissa::signals {
std::vector<Record> resampled_records(const std::string& path, const Sources& sources,
                                      const std::vector<std::vector<double>>& values,
                                      const double rate_hz, std::optional<Clock>& clock) {
  std::vector<std::span<const double>> signals(values.begin(), values.end() - 1);
  EvenEstimate even;
  try {
    even = resample_uneven(values.back(), signals, rate_hz);
  } catch (const UserError& error) {
    throw UserError(path + ": " + error.what());
  }
  clock.emplace();
  clock->sampling_rate_hz = rate_hz;
  std::vector<Record> records;
  for (std::size_t p = 0; p < even.first.size(); ++p) {
    const std::size_t first = even.first[p];
    const std::size_t end = p + 1 < even.first.size() ? even.first[p + 1] : even.times_s.size();
    clock->pieces.push_back({first, end - first, even.times_s[first]});
    if (end - first < least_samples) continue;
    records.emplace_back(rate_hz, end - first, even.times_s[first]);
    for (std::size_t c = 0; c < sources.channels.size(); ++c) {
      const auto begin = even.signals[c].begin() + std::ptrdiff_t(first);
      records.back().set_channel(sources.channels[c].channel,
                                 {begin, begin + std::ptrdiff_t(end - first)});
    }
  }
  clock->words = "resampled to " + to_text(rate_hz) + " Hz from " +
                 std::to_string(values.back().size()) +
                 " uneven stamps, as a signal without power above " + rounded(even.band_hz, 3) +
                 " Hz; the expected error is " + rounded(100. * even.error_share, 3) +
                 " % of a signal that fills this band";
  if (records.empty())
    throw UserError(path + ": no piece between gaps has " + std::to_string(least_samples) +
                    " samples at " + to_text(rate_hz) + " Hz");
  return records;
}

}  // namespace vibrissa::signals
