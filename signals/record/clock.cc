#include "signals/record/clock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/median.h"
#include "signals/base/number_text.h"
#include "signals/base/significant_digits.h"
#include "signals/record/stamp_regression.h"

namespace vibrissa::signals {
namespace {

double usual_step_of(const std::span<const double> times) {
  std::vector<double> steps;
  steps.reserve(times.size());
  for (std::size_t i = 1; i < times.size(); ++i)
    if (times[i] > times[i - 1]) steps.push_back(times[i] - times[i - 1]);
  return steps.empty() ? 0. : median(std::move(steps));
}

// Adds the range of a counter, in units of the column, behind each place where it starts anew.
// Returns how often.
std::size_t unwrap(const double unit_s, std::vector<double>& times_s) {
  constexpr auto ranges = std::to_array<double>(
      {65536., 16777216., 2147483648., 4294967296., 60., 3600., 86400., 1e6, 1e3});
  constexpr double most_steps = 50.;
  const double step = usual_step_of(times_s);
  double added = 0., before = times_s.front();
  std::size_t n_wraps = 0;
  for (std::size_t i = 1; i < times_s.size(); ++i) {
    const double fall = before - times_s[i];
    before = times_s[i];
    if (fall > most_steps * step) {
      for (const double range : ranges) {
        const double advance = range * unit_s - fall;
        if (advance < 0. || advance > most_steps * step) continue;
        added += range * unit_s;
        ++n_wraps;
        break;
      }
    }
    times_s[i] += added;
  }
  return n_wraps;
}

// Intervals: no growth over the file, but positive and alike.
bool are_intervals(const std::vector<double>& times) {
  const double usual = times.size() > 2 ? std::abs(times[times.size() / 2]) : 0.;
  const auto [least, most] = std::minmax_element(times.begin(), times.end());
  const std::size_t n_falls = std::size_t(std::inner_product(
      times.begin() + 1, times.end(), times.begin(), 0, std::plus<>(), std::less<>()));
  return *least > 0. && *least < *most && *most < 20. * usual && 8 * n_falls > times.size();
}

std::string words_of(const Clock& clock, const std::size_t n_stamps, const std::string& column) {
  const int digits = std::clamp(
      int(std::log10(clock.sampling_rate_hz / std::max(clock.rate_error_hz, 1e-300))) + 2, 3, 9);
  return rounded(clock.sampling_rate_hz, digits) + " +- " + rounded(clock.rate_error_hz, 1) +
         " Hz by regression over the " + std::to_string(n_stamps) + " stamps of '" + column +
         "', " +
         (clock.packet > 1
              ? "which come in packets of " + std::to_string(clock.packet) + " with one stamp and "
              : "which ") +
         (clock.is_from_bursts ? "come in bursts, as from a buffer: they leave the mean by "
                               : "jitter by ") +
         rounded(1e3 * clock.jitter_s, 2) + " ms";
}

std::string lost_words(const Clock& clock) {
  if (clock.n_lost == 0) return {};
  return "; " + std::to_string(clock.n_lost) + (clock.n_lost == 1 ? " sample is" : " samples are") +
         " lost at " + std::to_string(clock.pieces.size() - 1) +
         (clock.pieces.size() == 2 ? " place" : " places");
}

// Before a further recording in the file time starts anew.
bool starts_anew(const std::span<const double> times, const std::size_t i, const double step) {
  return times[i] < times[i - 1] - 10. * step && std::abs(times[i] - times[0]) < 2. * step;
}

std::size_t n_twice(const std::span<const double> times_s) {
  std::size_t n = 0;
  for (std::size_t i = 1; i < times_s.size(); ++i)
    if (times_s[i] == times_s[i - 1]) ++n;
  return n;
}

// Stamps that stand twice although samples are further apart than what their digits tell.
std::string twice_words(const PrintedTimes& times, const Clock& clock, const double rounding_s) {
  const std::size_t n = n_twice(times.times_s);
  if (n == 0 || clock.packet > 1 || 2. * rounding_s * clock.sampling_rate_hz >= 1.) return {};
  return "; " + std::to_string(n) + (n == 1 ? " stamp stands" : " stamps stand") + " twice";
}

// Whether single stamps of an even grid stand twice: rows that were stored twice.
bool holds_rows_twice(const PrintedTimes& times) {
  const std::size_t n = n_twice(times.times_s);
  if (n == 0 || 3 * n > times.times_s.size()) return false;
  std::vector<double> distinct(times.times_s.begin(), times.times_s.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  PrintedTimes single = times;
  single.times_s = distinct;
  return uniform_axis(single).has_value();
}

std::optional<Clock> clock_of_one(const PrintedTimes& times) {
  if (times.times_s.size() < 2 || holds_rows_twice(times)) return {};
  if (const auto axis = uniform_axis(times))
    return Clock{.sampling_rate_hz = axis->sampling_rate_hz,
                 .pieces = {{0, times.times_s.size(), axis->start_s}},
                 .words = rate_text(axis->sampling_rate_hz) + " from '" + times.column + "'"};
  const double rounding = rounding_of(times, times.times_s.size() - 1);
  auto clock = regress_stamps(times.times_s, rounding);
  if (!clock) return {};
  clock->words = words_of(*clock, times.times_s.size(), times.column) + lost_words(*clock) +
                 twice_words(times, *clock, rounding);
  return clock;
}

// One rate for all blocks, weighted by their lengths.
Clock joined(const std::vector<Clock>& clocks, const std::vector<std::size_t>& starts) {
  Clock all;
  double weight = 0.;
  for (std::size_t b = 0; b < clocks.size(); ++b) {
    const Clock& clock = clocks[b];
    double samples = 0.;
    for (ClockPiece piece : clock.pieces) {
      samples += double(piece.count);
      piece.first += starts[b];
      all.pieces.push_back(piece);
    }
    all.sampling_rate_hz += samples * clock.sampling_rate_hz;
    all.rate_error_hz += std::pow(samples * clock.rate_error_hz, 2);
    all.jitter_s = std::max(all.jitter_s, clock.jitter_s);
    all.n_lost += clock.n_lost;
    weight += samples;
  }
  all.sampling_rate_hz /= weight;
  all.rate_error_hz = std::sqrt(all.rate_error_hz) / weight;
  return all;
}

PrintedTimes part_of(const PrintedTimes& times, const std::size_t first, const std::size_t end) {
  PrintedTimes part = times;
  part.times_s = times.times_s.subspan(first, end - first);
  part.first_line = times.first_line + first;
  if (times.line_of)
    part.line_of = [times, first](std::size_t i) { return times.line_of(first + i); };
  return part;
}

/// Makes times of intervals, or of a counter that wraps around; what was done, in words.
std::string undo_intervals_and_wraps(const PrintedTimes& printed, std::vector<double>& times_s,
                                     PrintedTimes& times) {
  if (are_intervals(times_s)) {
    for (std::size_t i = 1; i < times_s.size(); ++i) times_s[i] += times_s[i - 1];
    return "'" + times.column + "' holds intervals: ";
  }
  const std::size_t n = unwrap(times.unit_s, times_s);
  if (n == 0) return {};
  times.fixed_rounding_s = rounding_of(printed, printed.times_s.size() - 1);
  return "the counter '" + times.column + "' wraps around " + std::to_string(n) +
         (n == 1 ? " time: " : " times: ");
}

}  // namespace

Clock find_clock(const PrintedTimes& printed, const std::vector<std::size_t>& block_starts) {
  PrintedTimes times = printed;
  std::vector<double> summed;
  std::string before;
  std::vector<std::size_t> starts = block_starts;
  // Most times only rise, and a long record needs no copy of them.
  if (!std::ranges::is_sorted(printed.times_s)) {
    summed.assign(printed.times_s.begin(), printed.times_s.end());
    before = undo_intervals_and_wraps(printed, summed, times);
    times.times_s = summed;
    const double step = usual_step_of(summed);
    for (std::size_t i = 1; i < summed.size(); ++i)
      if (starts_anew(summed, i, step)) starts.push_back(i);
  }
  starts.push_back(0);
  starts.push_back(times.times_s.size());
  std::ranges::sort(starts);
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  std::vector<Clock> clocks;
  for (std::size_t b = 0; b + 1 < starts.size(); ++b) {
    const PrintedTimes part = part_of(times, starts[b], starts[b + 1]);
    auto clock = clock_of_one(part);
    if (!clock) refuse_uneven_times(part);
    clocks.push_back(std::move(*clock));
  }
  if (clocks.size() == 1) {
    clocks.front().words = before + clocks.front().words;
    return clocks.front();
  }
  Clock all = joined(clocks, starts);
  for (const Clock& clock : clocks)
    if (std::abs(clock.sampling_rate_hz / all.sampling_rate_hz - 1.) > 1e-2)
      throw UserError(times.file + ": the recordings in the file have different rates (" +
                      rate_text(clock.sampling_rate_hz) + " and " +
                      rate_text(all.sampling_rate_hz) + " on average); choose one by --rows");
  all.words = before + rounded(all.sampling_rate_hz, 7) + " Hz from '" + times.column + "'; " +
              std::to_string(clocks.size()) + " recordings in the file" + lost_words(all);
  return all;
}

void refuse_lost_samples(const PrintedTimes& times, const Clock& clock) {
  if (clock.pieces.size() < 2) return;
  const ClockPiece& second = clock.pieces[1];
  throw UserError(times.file + ": " + std::to_string(clock.n_lost) +
                  (clock.n_lost == 1 ? " sample is" : " samples are") + " lost, the first before " +
                  times.row_word + " " +
                  std::to_string(times.line_of ? times.line_of(second.first)
                                               : times.first_line + second.first) +
                  "; samples are never added: --gaps pieces reads the longest piece, --rows "
                  "chooses one");
}

}  // namespace vibrissa::signals
