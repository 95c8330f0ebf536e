#include "signals/files/joined_recording.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/base/significant_digits.h"
#include "signals/files/record_rows.h"
#include "signals/spectra/band_limited_signal.h"

namespace vibrissa::signals {
namespace {

/// Time of the fast device = offset + pace * time of the slow one.
struct FastClock {
  double offset_s = 0., pace = 1.;
  double fast_time_s(const double slow_time_s) const { return offset_s + pace * slow_time_s; }
  double slow_time_s(const double fast_time_s) const { return (fast_time_s - offset_s) / pace; }
};

// The values at the times of the record, of the clock that `place_of` gives in samples.
template <typename PlaceOf>
void take_channels(const Record& from, const double rate_hz, const PlaceOf& place_of,
                   Record& record) {
  for (const std::string& name : from.channel_names()) {
    const auto between =
        BandLimitedSignal::at_rate(from.channel(name), from.sampling_rate_hz(), rate_hz);
    std::vector<double> taken(record.n_samples());
    for (std::size_t i = 0; i < taken.size(); ++i) taken[i] = between.at(place_of(i));
    record.set_channel(name, std::move(taken));
  }
}

// Adds the overlap of two pieces.
void add_overlap(const Record& slow, const Record& fast, const FastClock& clock,
                 const SlowerDevice slower, std::vector<Record>& records) {
  const double rate = slow.sampling_rate_hz();
  const auto row_of = [&](const double time_s) { return (time_s - slow.time_s(0)) * rate; };
  const double end_s = fast.time_s(fast.n_samples() - 1);
  const double margin = BandLimitedSignal::half_length_samples;
  const double from = std::ceil(std::max(0., row_of(clock.slow_time_s(fast.time_s(0)))) + margin);
  const double to =
      std::floor(std::min(double(slow.n_samples() - 1), row_of(clock.slow_time_s(end_s))) - margin);
  if (to - from + 1. < double(least_samples)) return;
  Record record = slow.slice(std::size_t(from), std::size_t(to - from) + 1);
  if (slower == SlowerDevice::filtered_alike)
    take_channels(
        slow, rate, [&](const std::size_t i) { return from + double(i); }, record);
  const auto fast_place = [&](const std::size_t i) {
    return (clock.fast_time_s(record.time_s(i)) - fast.time_s(0)) * fast.sampling_rate_hz();
  };
  take_channels(fast, rate, fast_place, record);
  records.push_back(std::move(record));
}

void check_channels(const Record& one, const Record& other) {
  for (const std::string& name : other.channel_names())
    if (one.has(name))
      throw UserError("--join: both files have a column for channel " + name +
                      "; choose the columns so that each channel comes from one file, or let the "
                      "motion in both tell the clocks (--align motion)");
}

void check_epochs(const Recording& one, const Recording& other) {
  if ((one.epoch_s == 0.) != (other.epoch_s == 0.))
    throw UserError(
        "--join: one file has dates or seconds since 1970, the other one has not, so their clocks "
        "cannot be compared; give both the same kind of time, or --align motion");
}

bool is_slower(const Recording& one, const Recording& other) {
  return one.pieces.front().sampling_rate_hz() <= other.pieces.front().sampling_rate_hz();
}

Recording overlap_of(const Recording& slow, const Recording& fast, const FastClock& clock,
                     const SlowerDevice slower) {
  Recording both;
  both.epoch_s = slow.epoch_s;
  for (const Record& a : slow.pieces)
    for (const Record& b : fast.pieces) add_overlap(a, b, clock, slower, both.pieces);
  if (both.pieces.empty())
    throw UserError("--join: the two files have no " + std::to_string(least_samples) +
                    " samples at the same time (the slower device begins at " +
                    to_text(slow.epoch_s + slow.pieces.front().time_s(0)) + " s, the other at " +
                    to_text(slow.epoch_s + clock.slow_time_s(fast.pieces.front().time_s(0))) +
                    " s)");
  return both;
}

std::string joined_words(const Recording& both, const std::string& clock) {
  return "joined on the clock of " + clock + " at " +
         rate_text(both.pieces.front().sampling_rate_hz()) + ", without what is above " +
         to_text(
             std::round(BandLimitedSignal::flat_share * both.pieces.front().sampling_rate_hz())) +
         " Hz: " + std::to_string(both.pieces.front().n_samples()) + " samples" +
         (both.pieces.size() > 1
              ? " in the first of " + std::to_string(both.pieces.size()) + " pieces"
              : "");
}

Recording without_channels_of(const Recording& other, const Recording& one) {
  Recording rest = other;
  for (Record& piece : rest.pieces) {
    Record kept(piece.sampling_rate_hz(), piece.n_samples(), piece.time_s(0));
    for (const std::string& name : piece.channel_names()) {
      if (one.pieces.front().has(name)) continue;
      const auto values = piece.channel(name);
      kept.set_channel(name, {values.begin(), values.end()});
    }
    piece = std::move(kept);
  }
  return rest;
}

ClockedSignal longest_of(const Recording& recording, const std::string& channel) {
  const Record& piece = recording.pieces[recording.longest()];
  return {piece.channel(channel), piece.sampling_rate_hz(), piece.time_s(0)};
}

std::string with_deviation(const double value, const double deviation) {
  // Two digits of the deviation.
  const int digits =
      deviation > 0. ? std::clamp(1 - int(std::floor(std::log10(deviation))), 0, 9) : 9;
  char text[64];
  std::snprintf(text, sizeof text, "%.*f ± %.*f", digits, value, digits, deviation);
  return text;
}

}  // namespace

Recording joined(const Recording& one, const Recording& other) {
  check_channels(one.pieces.front(), other.pieces.front());
  check_epochs(one, other);
  const bool is_one_slower = is_slower(one, other);
  const Recording &slow = is_one_slower ? one : other, &fast = is_one_slower ? other : one;
  Recording both =
      overlap_of(slow, fast, {slow.epoch_s - fast.epoch_s, 1.}, SlowerDevice::filtered_alike);
  both.words = joined_words(both, "the stamps");
  return both;
}

Recording joined(const Recording& one, const Recording& other, const ClockRelation& clocks,
                 const SlowerDevice slower) {
  const Recording rest = without_channels_of(other, one);
  const double pace = 1. + clocks.drift;
  Recording both = is_slower(one, other)
                       ? overlap_of(one, rest, {-clocks.offset_s / pace, 1. / pace}, slower)
                       : overlap_of(rest, one, {clocks.offset_s, pace}, slower);
  both.words =
      joined_words(both, is_slower(one, other) ? "the first file" : "the second, slower file") +
      "; " + clock_words(clocks);
  return both;
}

std::optional<std::string> shared_channel(const Recording& one, const Recording& other) {
  std::optional<std::string> shared;
  for (const std::string& name : other.pieces.front().channel_names()) {
    if (!one.pieces.front().has(name)) continue;
    if (name == channel::base_acceleration || name == channel::cross_acceleration) return name;
    if (!shared) shared = name;
  }
  return shared;
}

ClockRelation clocks_of(const Recording& one, const std::string& channel_of_one,
                        const Recording& other, const std::string& channel_of_other,
                        const SharedMotion shared) {
  return relate_clocks(longest_of(one, channel_of_one), longest_of(other, channel_of_other),
                       shared);
}

std::string clock_words(const ClockRelation& clocks) {
  const double ppm = 1e6 * clocks.drift;
  return "time 0 of the second file is at " +
         with_deviation(clocks.offset_s, clocks.offset_deviation_s) +
         " s of the first, and its clock runs " +
         with_deviation(std::abs(ppm), 1e6 * clocks.drift_deviation) + " ppm " +
         (ppm > 0. ? "slow" : "fast") +
         (clocks.is_opposite ? "; the channel in both has opposite signs" : "");
}

}  // namespace vibrissa::signals
