#include "signals/record/time_axis.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/median.h"
#include "signals/base/number_text.h"
#include "signals/base/significant_digits.h"

namespace vibrissa::signals {

double rounding_of(const PrintedTimes& times, const std::size_t sample) {
  if (times.fixed_rounding_s) return *times.fixed_rounding_s;
  return std::abs(times.unit_s) * times.digits.rounding(times.times_s[sample] / times.unit_s);
}

namespace {

constexpr double jitter_periods = 1e-3;
// A lost sample moves some time by at least half a period from every uniform grid; less must be
// allowed.
constexpr double largest_tolerance_periods = 0.45;

std::string moment(const PrintedTimes& times, const std::size_t i) {
  const std::size_t line = times.line_of ? times.line_of(i) : times.first_line + i;
  return times.row_word + " " + std::to_string(line) + " (" + to_text(times.times_s[i]) + " s)";
}

std::string between(const PrintedTimes& times, const std::size_t i) {
  return " between " + moment(times, i - 1) + " and " + moment(times, i);
}

// Advice for lost or doubled samples: only the user can decide what replaces them.
std::string never_filled(const PrintedTimes& times) {
  return "; column '" + times.column +
         "': samples are never added or removed; use only the rows before this place or only the "
         "rows after it";
}

void check_runs_forward(const PrintedTimes& times) {
  for (std::size_t i = 1; i < times.times_s.size(); ++i) {
    const double step = times.times_s[i] - times.times_s[i - 1];
    if (step > 0.) continue;
    throw UserError(times.file + ": time " + (step < 0. ? "decreases" : "does not increase") +
                    between(times, i) + never_filled(times));
  }
}

double median_step(const std::span<const double> times_s) {
  std::vector<double> steps(times_s.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = times_s[i + 1] - times_s[i];
  return median(std::move(steps));
}

// The sample with the largest distance from the uniform grid through the first and the last sample,
// if the distance exceeds jitter and rounding; else zero.
std::size_t worst_off_grid(const PrintedTimes& times, const double period) {
  const auto t = times.times_s;
  const double end_rounding = std::max(rounding_of(times, 0), rounding_of(times, t.size() - 1));
  std::size_t worst = 0;
  double worst_distance = jitter_periods * period;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double distance = std::abs(t[i] - t[0] - static_cast<double>(i) * period);
    if (distance <= worst_distance) continue;
    const double tolerance =
        std::min(jitter_periods * period + rounding_of(times, i) + end_rounding,
                 largest_tolerance_periods * period);
    if (distance <= tolerance) continue;
    worst = i;
    worst_distance = distance;
  }
  return worst;
}

// Without the rounding errors of a difference, for messages.
std::string difference_text(const double difference_s) {
  return rounded(difference_s, 6);
}

// When a period is about one unit of the last digit, rounding looks like a lost sample.
std::string digits_advice(const PrintedTimes& times, const std::size_t i, const double error_s) {
  const double last_digit_s = 2. * rounding_of(times, i);
  const double most_by_rounding_s = 1.01 * last_digit_s;
  if (std::abs(error_s) > most_by_rounding_s) return {};
  return "; its last digit is " + difference_text(last_digit_s) +
         " s, which is too coarse: write the time with more digits";
}

void refuse_gap(const PrintedTimes& times, const double usual_step) {
  const auto t = times.times_s;
  std::size_t first = 0, n_gaps = 0;
  for (std::size_t i = 1; i < t.size(); ++i)
    if (t[i] - t[i - 1] > 1.5 * usual_step && ++n_gaps == 1) first = i;
  if (n_gaps == 0) return;
  const double step = t[first] - t[first - 1];
  const std::string more =
      n_gaps == 1 ? "" : " (" + std::to_string(n_gaps - 1) + " more gaps follow)";
  throw UserError(times.file + ": gap in time" + between(times, first) + ": " +
                  to_text(std::round(step / usual_step)) +
                  " sampling intervals where 1 was expected" + more +
                  digits_advice(times, first, step - usual_step) + never_filled(times));
}

void refuse_crowding(const PrintedTimes& times, const double usual_step) {
  const auto t = times.times_s;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double step = t[i] - t[i - 1];
    if (step < 0.5 * usual_step)
      throw UserError(times.file + ": only " + difference_text(step) + " s" + between(times, i) +
                      ", but " + difference_text(usual_step) + " s were expected" +
                      digits_advice(times, i, step - usual_step));
  }
}

[[noreturn]] void refuse_uneven(const PrintedTimes& times, const std::size_t worst,
                                const double period) {
  const double offset =
      times.times_s[worst] - times.times_s[0] - static_cast<double>(worst) * period;
  const double percent = with_significant_digits(100. * std::abs(offset) / period, 2);
  throw UserError(times.file + ": time is not uniform: " + moment(times, worst) + " lies " +
                  to_text(percent) +
                  " % of a period away from the uniform grid between the first and the last time" +
                  digits_advice(times, worst, offset) +
                  "; if the sampling is uniform and only the time stamps are not, remove the time "
                  "column and give --rate; otherwise resample the recording, as --resample does");
}

double simplest_rate(const double period, const double relative_uncertainty) {
  const double rate = 1. / period;
  const auto agrees = [&](const double candidate) {
    return std::abs(candidate - rate) <= relative_uncertainty * rate;
  };
  for (int n_digits = 1; n_digits <= 15; ++n_digits) {
    const double by_rate = with_significant_digits(rate, n_digits);
    if (agrees(by_rate)) return by_rate;
    const double by_period = 1. / with_significant_digits(period, n_digits);
    if (agrees(by_period)) return by_period;
  }
  return rate;
}

}  // namespace

void TimeDigits::see(const std::string_view text) {
  const auto exponent_at = std::min(text.find_first_of("eE"), text.size());
  int exponent = 0, decimals = 0, significant = 0;
  if (exponent_at < text.size()) {
    std::string_view digits = text.substr(exponent_at + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
  }
  bool after_point = false;
  for (const char c : text.substr(0, exponent_at)) {
    if (c == '.') after_point = true;
    if (c < '0' || c > '9') continue;
    if (significant > 0 || c != '0') ++significant;
    if (after_point) ++decimals;
  }
  decimals_ = std::max(decimals_, decimals - std::clamp(exponent, -400, 400));
  significant_ = std::max(significant_, significant);
}

double TimeDigits::rounding(const double time) const {
  double last_place = -decimals_;
  if (time != 0.)
    last_place = std::max(last_place, std::floor(std::log10(std::abs(time))) + 1. - significant_);
  return 0.5 * std::pow(10., last_place);
}

void refuse_uneven_times(const PrintedTimes& times) {
  check_runs_forward(times);
  const auto t = times.times_s;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.;
  for (std::size_t i = 1; i < t.size(); ++i) {
    shortest = std::min(shortest, t[i] - t[i - 1]);
    longest = std::max(longest, t[i] - t[i - 1]);
  }
  throw UserError(times.file + ": time is not uniform: the steps of column '" + times.column +
                  "' are between " + difference_text(shortest) + " and " +
                  difference_text(longest) +
                  " s, and no even clock with jitter or lost samples explains them; where the "
                  "sampling is even and only the stamps are not, give --rate in Hz and a --column "
                  "for each channel but none for time; otherwise give --resample RATE");
}

std::optional<TimeAxis> uniform_axis(const PrintedTimes& times) {
  const auto t = times.times_s;
  assert(t.size() >= 2 && times.unit_s != 0.);
  if (std::adjacent_find(t.begin(), t.end(), std::greater_equal<>()) != t.end()) return {};
  const double duration = t.back() - t.front();
  const double period = duration / static_cast<double>(t.size() - 1);
  if (worst_off_grid(times, period) != 0) return {};
  const double rounding = rounding_of(times, 0) + rounding_of(times, t.size() - 1);
  const double unit_in_last_place =
      std::numeric_limits<double>::epsilon() * std::max(std::abs(t.front()), std::abs(t.back()));
  const double uncertainty = (rounding + 2. * unit_in_last_place) / duration;
  return TimeAxis{t.front(), simplest_rate(period, uncertainty)};
}

TimeAxis find_time_axis(const PrintedTimes& times) {
  if (const auto axis = uniform_axis(times)) return *axis;
  check_runs_forward(times);
  const auto t = times.times_s;
  const double period = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  const double usual_step = median_step(t);
  refuse_gap(times, usual_step);
  refuse_crowding(times, usual_step);
  refuse_uneven(times, worst_off_grid(times, period), period);
}

}  // namespace vibrissa::signals
