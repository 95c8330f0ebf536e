#include "signals/files/joined_recording.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/files/record_rows.h"

namespace vibrissa::signals {
namespace {

constexpr double half_length = 32., cutoff_share = 0.42;  // in samples and shares of the lower rate

double kaiser(const double share) {
  constexpr double beta = 8.;
  if (std::abs(share) >= 1.) return 0.;
  return std::cyl_bessel_i(0., beta * std::sqrt(1. - share * share)) / std::cyl_bessel_i(0., beta);
}

// The low-passed channel at a time, from the samples within half a kernel.
double value_at(const std::span<const double> values, const double sample, const double cutoff,
                const double reach) {
  const double first = std::max(0., std::ceil(sample - reach));
  const double last = std::min(double(values.size() - 1), std::floor(sample + reach));
  double sum = 0., weights = 0.;
  for (double i = first; i <= last; i += 1.) {
    const double lag = i - sample, x = 2. * std::numbers::pi * cutoff * lag;
    const double weight = (std::abs(x) < 1e-12 ? 1. : std::sin(x) / x) * kaiser(lag / reach);
    sum += weight * values[std::size_t(i)];
    weights += weight;
  }
  return sum / weights;
}

struct Pair {
  const Record& slow;
  const Record& fast;
  double fast_is_ahead_s;  // zero of the fast clock minus that of the slow one
};

// Adds the overlap of two pieces.
void add_overlap(const Pair& pair, std::vector<Record>& records) {
  const double rate = pair.slow.sampling_rate_hz(), fast_rate = pair.fast.sampling_rate_hz();
  const double margin_s = half_length / rate;
  const double start = pair.fast.time_s(0) + pair.fast_is_ahead_s + margin_s;
  const double end = start - 2. * margin_s + double(pair.fast.n_samples() - 1) / fast_rate;
  const double from = std::max(0., std::ceil((start - pair.slow.time_s(0)) * rate));
  const double to =
      std::min(double(pair.slow.n_samples() - 1), std::floor((end - pair.slow.time_s(0)) * rate));
  if (to - from + 1. < double(least_samples)) return;
  Record record = pair.slow.slice(std::size_t(from), std::size_t(to - from) + 1);
  const double reach = half_length * fast_rate / rate;
  for (const std::string& name : pair.fast.channel_names()) {
    const auto values = pair.fast.channel(name);
    std::vector<double> taken(record.n_samples());
    for (std::size_t i = 0; i < taken.size(); ++i) {
      const double sample =
          (record.time_s(i) - pair.fast_is_ahead_s - pair.fast.time_s(0)) * fast_rate;
      taken[i] = value_at(values, sample, cutoff_share * rate / fast_rate, reach);
    }
    record.set_channel(name, std::move(taken));
  }
  records.push_back(std::move(record));
}

void check_channels(const Record& one, const Record& other) {
  for (const std::string& name : other.channel_names())
    if (one.has(name))
      throw UserError("--join: both files have a column for channel " + name +
                      "; choose the columns so that each channel comes from one file");
}

}  // namespace

Recording joined(const Recording& one, const Recording& other) {
  check_channels(one.pieces.front(), other.pieces.front());
  if ((one.epoch_s == 0.) != (other.epoch_s == 0.))
    throw UserError(
        "--join: one file has dates or seconds since 1970, the other one has not, so their clocks "
        "cannot be compared; give both the same kind of time");
  const bool is_one_slower =
      one.pieces.front().sampling_rate_hz() <= other.pieces.front().sampling_rate_hz();
  const Recording &slow = is_one_slower ? one : other, &fast = is_one_slower ? other : one;
  Recording both;
  both.epoch_s = slow.epoch_s;
  for (const Record& a : slow.pieces)
    for (const Record& b : fast.pieces)
      add_overlap({a, b, fast.epoch_s - slow.epoch_s}, both.pieces);
  if (both.pieces.empty())
    throw UserError("--join: the two files have no " + std::to_string(least_samples) +
                    " samples at the same time (the first begins at " +
                    to_text(one.epoch_s + one.pieces.front().time_s(0)) + " s, the other at " +
                    to_text(other.epoch_s + other.pieces.front().time_s(0)) + " s)");
  both.words =
      "joined on the clock of the stamps at " + to_text(slow.pieces.front().sampling_rate_hz()) +
      " Hz: " + std::to_string(both.pieces.front().n_samples()) + " samples" +
      (both.pieces.size() > 1 ? " in the first of " + std::to_string(both.pieces.size()) + " pieces"
                              : "");
  return both;
}

}  // namespace vibrissa::signals
