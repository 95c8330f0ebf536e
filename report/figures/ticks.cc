#include "report/figures/ticks.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>

namespace vibrissa::report {
namespace {

/// Ticks beyond the range by up to this share of its length count as inside.
constexpr double tolerance = 1e-9;

const std::string minus = "\u2212";

std::string fixed(const double value, const int n_decimals) {
  std::array<char, 400> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.*f", n_decimals, std::abs(value));
  const std::string digits = buffer.data();
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  return value < 0. && !zero ? minus + digits : digits;
}

double decimal_step(const double smallest) {
  const double power = std::pow(10., std::floor(std::log10(smallest)));
  for (const double factor : {1., 2., 5.})
    if (factor * power >= smallest * (1. - tolerance)) return factor * power;
  return 10. * power;
}

double degree_step(const double smallest) {
  for (const double step : {1., 2., 5., 10., 15., 30., 45., 90., 180.})
    if (step >= smallest * (1. - tolerance)) return step;
  return 360. * std::ceil(smallest / 360.);
}

/// A power of a thousand (engineering notation) when plain numbers would be long.
int common_exponent(const Range& range) {
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  const int exponent = static_cast<int>(std::floor(std::log10(largest)));
  if (exponent >= -2 && exponent <= 4) return 0;
  return 3 * static_cast<int>(std::floor(exponent / 3.));
}

/// 0.01 .. 1000 in plain numbers when the axis has nothing beyond them.
std::string value_label(const int digit, const int exponent, const bool plain) {
  if (plain) return fixed(digit * std::pow(10., exponent), std::max(0, -exponent));
  if (digit == 1) return power_of_ten(exponent);
  return std::to_string(digit) + "\u00d7" + power_of_ten(exponent);
}

int n_inside(const Range& range, const std::vector<int>& digits) {
  int n = 0;
  for (int e = static_cast<int>(std::floor(range.low)); e <= range.high; ++e)
    for (const int digit : digits) n += range.contains(e + std::log10(digit));
  return n;
}

/// The multiples of the powers of ten that get labels: as many as fit, but at least three.
std::vector<int> labelled_digits(const Range& range, const int n_most) {
  std::vector<int> best;
  for (const std::vector<int>& digits :
       {std::vector<int>{1}, {1, 3}, {1, 2, 5}, {1, 2, 3, 4, 5, 6, 7, 8, 9}}) {
    const int n = n_inside(range, digits);
    const bool enough = n_inside(range, best) >= 3;
    if (n >= 3 && (!enough || (n <= n_most && digits.size() <= 3))) best = digits;
  }
  return best;
}

Ticks linear_ticks_on_logarithmic_axis(const Range& range, const int n_most) {
  Ticks ticks = linear_ticks({std::pow(10., range.low), std::pow(10., range.high)}, n_most);
  std::erase_if(ticks.marks, [](const Tick& mark) { return mark.at <= 0.; });
  for (Tick& mark : ticks.marks) mark.at = std::log10(mark.at);
  return ticks;
}

}  // namespace

std::string power_of_ten(const int exponent) {
  const std::array<const char*, 10> superscripts = {"\u2070", "\u00b9", "\u00b2", "\u00b3",
                                                    "\u2074", "\u2075", "\u2076", "\u2077",
                                                    "\u2078", "\u2079"};
  std::string text = "10";
  if (exponent < 0) text += "\u207b";
  for (const char digit : std::to_string(std::abs(exponent)))
    text += superscripts[static_cast<std::size_t>(digit - '0')];
  return text;
}

Ticks linear_ticks(const Range& range, const int n_most, const bool degrees) {
  assert(range.length() > 0. && n_most >= 2);
  const double smallest = range.length() / n_most;
  const double step = degrees ? degree_step(smallest) : decimal_step(smallest);
  Ticks ticks;
  ticks.exponent = degrees ? 0 : common_exponent(range);
  const double scale = std::pow(10., -ticks.exponent);
  const int n_decimals =
      std::max(0, -static_cast<int>(std::floor(std::log10(step * scale) + tolerance)));
  const double margin = tolerance * range.length();
  const double first = std::ceil((range.low - margin) / step);
  for (int i = 0; i <= n_most; ++i) {
    const double at = (first + i) * step;
    if (at <= range.high + margin) ticks.marks.push_back({at, fixed(at * scale, n_decimals)});
  }
  return ticks;
}

Ticks logarithmic_ticks(const Range& given, const int n_most) {
  assert(given.length() > 0. && n_most >= 2);
  const double margin = tolerance * given.length();
  const Range range{given.low - margin, given.high + margin};
  const auto digits = labelled_digits(range, n_most);
  if (digits.empty()) return linear_ticks_on_logarithmic_axis(given, n_most);
  const int lowest = static_cast<int>(std::floor(range.low));
  const int highest = static_cast<int>(std::floor(range.high));
  const bool plain = range.low >= -3. && range.high <= 4.5;
  const int stride = 1 + n_inside(range, {1}) / (n_most + 1);
  Ticks ticks;
  for (int e = lowest; e <= highest; ++e) {
    for (int digit = 1; digit <= 9; ++digit) {
      const double at = e + std::log10(digit);
      if (!range.contains(at)) continue;
      const bool labelled = std::find(digits.begin(), digits.end(), digit) != digits.end();
      if (labelled && e % stride == 0)
        ticks.marks.push_back({at, value_label(digit, e, plain)});
      else if (stride == 1 || digit == 1)
        ticks.marks.push_back({at, ""});
    }
  }
  return ticks;
}

}  // namespace vibrissa::report
