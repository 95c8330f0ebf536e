#pragma once

#include <optional>
#include <string>
#include <utility>

namespace vibrissa::signals::formats {

/// Two numbers of an abscissa, of which the format itself keeps six digits, exactly: "NAME=a
/// NAME=b" as the text of a function's fourth line. Proven by
/// tests/signals/formats/response_file_test.cc and tests/signals/formats/uff58_file_test.cc.
struct ExactPair {
  std::string first_name, second_name;

  std::string line(double first, double second) const;
  /// Both, from such a line; nothing from any other.
  std::optional<std::pair<double, double>> in(const std::string& line) const;
};

/// Of even frequencies, and of a record's clock.
inline const ExactPair frequency_grid{"start_hz", "step_hz"};
inline const ExactPair record_clock{"sampling_rate_hz", "start_s"};

}  // namespace vibrissa::signals::formats
