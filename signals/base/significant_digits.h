#pragma once

#include <array>
#include <charconv>
#include <string>

#include "signals/base/number_text.h"

namespace vibrissa::signals {

/// The nearest number with so many significant digits, at least 1. Proven by
/// tests/signals/base/significant_digits_test.cc.
inline double with_significant_digits(const double value, const int n_digits) {
  std::array<char, 40> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::scientific, n_digits - 1)
                       .ptr;
  double rounded = value;
  std::from_chars(text.data(), end, rounded);
  return rounded;
}

/// Its text. Proven by tests/signals/base/significant_digits_test.cc.
inline std::string rounded(const double value, const int n_digits) {
  return to_text(with_significant_digits(value, n_digits));
}

/// "500.00002 Hz" of an estimated rate. Proven by tests/signals/base/significant_digits_test.cc.
inline std::string rate_text(const double rate_hz) {
  return rounded(rate_hz, 8) + " Hz";
}

}  // namespace vibrissa::signals
