#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vibrissa::signals {

/// Resolution of a printed time column: the largest number of decimals and of significant digits of
/// its values. One value is not enough, because trailing zeros may be missing.
class TimeDigits {
 public:
  /// Adds one time; text is the number as it is printed in the file.
  void see(std::string_view text);
  /// Half a unit of the last digit of this time, in the unit of the column.
  double rounding(double time) const;

 private:
  int decimals_ = 0, significant_ = 1;
};

/// Times of a file. Sample i is in line (or row) first_line + i.
struct PrintedTimes {
  std::span<const double> times_s;
  TimeDigits digits;
  double unit_s = 1.;  // unit of the column in seconds
  std::string file;
  std::size_t first_line = 2;
  std::string column = "time_s";
  std::string row_word = "line";
  /// Half a unit of the last digit, where the digits do not tell it: behind a counter that wraps.
  std::optional<double> fixed_rounding_s = {};
  /// Line (or row) of a sample where lines without samples are between them.
  std::function<std::size_t(std::size_t sample)> line_of = {};
};

struct TimeAxis {
  double start_s;
  double sampling_rate_hz;
};

/// Finds the uniform grid of the times, within 1e-3 of a sampling interval and the rounding of the
/// printed digits. Several rates may agree with the digits; the result is the rate that has, or
/// whose period has, the fewest digits. Needs at least two times. Throws UserError with file and
/// line when time decreases or repeats, for a gap, for an interval that is too short, and for a
/// grid that is not uniform. Proven by tests/signals/record/time_axis_test.cc.
TimeAxis find_time_axis(const PrintedTimes& times);

/// Throws UserError for times that no even clock explains; the message says which steps there are.
[[noreturn]] void refuse_uneven_times(const PrintedTimes& times);

/// The same as find_time_axis; nothing where find_time_axis throws.
std::optional<TimeAxis> uniform_axis(const PrintedTimes& times);

/// Half a unit of the last digit of a time, in seconds.
double rounding_of(const PrintedTimes& times, std::size_t sample);

}  // namespace vibrissa::signals
