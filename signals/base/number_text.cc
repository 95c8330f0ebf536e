#include "signals/base/number_text.h"

#include <array>
#include <charconv>
#include <cstdlib>
#include <system_error>

namespace vibrissa::signals {

std::string to_text(const double value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return std::string(buffer.data(), end);
}

namespace {

constexpr auto powers_of_ten =
    std::to_array<double>({1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                           1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22});

bool is_digit(const char c) {
  return c >= '0' && c <= '9';
}

// Most numbers have few digits: their digits and the power of ten are exact doubles, so one
// operation rounds as it must (Clinger 1990). Takes half of the time of from_chars; nothing for
// other text.
std::optional<double> few_digits(const std::string_view text) {
  constexpr int most_digits = 15;
  const char *at = text.data(), *const end = at + text.size();
  const double sign = at != end && *at == '-' ? -1. : 1.;
  if (sign < 0.) ++at;
  long digits = 0;
  int n_digits = 0, exponent = 0;
  for (; at != end && is_digit(*at) && n_digits < most_digits; ++at, ++n_digits)
    digits = 10 * digits + (*at - '0');
  if (at != end && *at == '.')
    for (++at; at != end && is_digit(*at) && n_digits < most_digits; ++at, ++n_digits, --exponent)
      digits = 10 * digits + (*at - '0');
  if (n_digits == 0) return {};
  if (at != end && (*at == 'e' || *at == 'E')) {
    int given = 0;
    if (++at != end && *at == '+' && ++at != end && !is_digit(*at)) return {};
    const auto [stop, error] = std::from_chars(at, end, given);
    if (error != std::errc() || std::abs(given) > 2 * most_digits) return {};
    at = stop;
    exponent += given;
  }
  const int last = int(powers_of_ten.size()) - 1;
  if (at != end || exponent < -last || exponent > last) return {};
  const double whole = sign * double(digits);
  return exponent < 0 ? whole / powers_of_ten[std::size_t(-exponent)]
                      : whole * powers_of_ten[std::size_t(exponent)];
}

}  // namespace

std::optional<double> to_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  if (const auto number = few_digits(text)) return number;
  double value = 0.;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

}  // namespace vibrissa::signals
