#pragma once

#include <optional>
#include <string>
#include <utility>

namespace vibrissa::signals::formats {

/// Two exact numbers of an abscissa, as text "NAME=a NAME=b" in the fourth line of a function. The
/// format itself keeps only six digits. Proven by tests/signals/formats/response_file_test.cc and
/// tests/signals/formats/uff58_file_test.cc.
struct ExactPair {
  std::string first_name, second_name;

  std::string line(double first, double second) const;
  /// The two numbers of such a line; nothing for another line.
  std::optional<std::pair<double, double>> in(const std::string& line) const;
};

/// For uniform frequencies, and for the sampling of a record.
inline const ExactPair frequency_grid{"start_hz", "step_hz"};
inline const ExactPair record_clock{"sampling_rate_hz", "start_s"};

}  // namespace vibrissa::signals::formats
