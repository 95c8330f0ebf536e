#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace vibrissa::signals {

/// How finely a column of times is printed: the most decimals and the most significant digits that
/// any of them has. Trailing zeros may have been cut, so one value alone does not tell.
class TimeDigits {
 public:
  /// Looks at one more time; text is a number as printed in the file.
  void see(std::string_view text);
  /// Half a unit of the last digit of this time, in the column's own unit.
  double rounding(double time) const;

 private:
  int decimals_ = 0, significant_ = 1;
};

/// Times as a file gives them. Sample i is in line (or row) first_line + i.
struct PrintedTimes {
  std::span<const double> times_s;
  TimeDigits digits;
  double unit_s = 1.;  // unit of the column in seconds
  std::string file;
  std::size_t first_line = 2;
  std::string column = "time_s";
  std::string row_word = "line";
};

struct TimeAxis {
  double start_s;
  double sampling_rate_hz;
};

/// The even grid on which the times lie to within 1e-3 of a period and the rounding of their
/// printed digits. Of the rates that agree with the digits it takes the one that, or whose period,
/// has the fewest digits. Needs two times. Throws UserError with file and line for time that runs
/// backward or stands still, a gap, a crowded sample, a grid that is not even. Proven by
/// tests/signals/record/time_axis_test.cc.
TimeAxis find_time_axis(const PrintedTimes& times);

}  // namespace vibrissa::signals
