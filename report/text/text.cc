#include "report/text/text.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace vibrissa::report {
namespace {

std::string formatted(const char* format, const int precision, const double value) {
  std::array<char, 64> buffer;
  const int length = std::snprintf(buffer.data(), buffer.size(), format, precision, value);
  assert(length > 0 && static_cast<std::size_t>(length) < buffer.size());
  return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string without_trailing_zeros(std::string decimal) {
  if (decimal.find('.') == std::string::npos) return decimal;
  decimal.erase(decimal.find_last_not_of('0') + 1);
  if (decimal.back() == '.') decimal.pop_back();
  return decimal;
}

}  // namespace

std::string significant(const double value, const int n_digits) {
  assert(n_digits >= 1 && n_digits <= 17);
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0. ? "inf" : "-inf";
  if (value == 0.) return "0";
  // The exponent after rounding: 9.996 with three digits is 10.0 and has one decimal.
  const std::string rounded = formatted("%.*e", n_digits - 1, value);
  const std::size_t e = rounded.find('e');
  const int exponent = std::atoi(rounded.c_str() + e + 1);
  if (exponent < -4 || exponent >= 6)
    return without_trailing_zeros(rounded.substr(0, e)) + rounded.substr(e);
  return without_trailing_zeros(formatted("%.*f", std::max(0, n_digits - 1 - exponent), value));
}

std::string csv_field(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return text.find_first_of(",\"") == std::string::npos ? quoted : '"' + quoted + '"';
}

std::size_t n_characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](const char c) {
    return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;
  }));
}

}  // namespace vibrissa::report
