#include "report/figures/packed_numbers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "report/text/base64.h"

namespace vibrissa::report {
namespace {

static_assert(std::endian::native == std::endian::little, "the page reads little-endian numbers");

double tick(const double first, const double rate, const std::size_t i) {
  return first + static_cast<double>(i) / rate;
}

/// Uniform samples first + i / rate, when they reproduce each value exactly.
std::optional<nlohmann::json> as_ticks(const std::vector<double>& values) {
  if (values.size() < 3) return {};
  const double first = values.front(), length = values.back() - first;
  const double rate = std::round(static_cast<double>(values.size() - 1) / length);
  if (!std::isfinite(rate) || rate < 1. || std::signbit(first)) return {};
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] != tick(first, rate, i)) return {};
  return nlohmann::json{{"n", values.size()}, {"first", first}, {"rate", rate}};
}

bool is_single(const double value) {
  return std::isnan(value) || static_cast<double>(static_cast<float>(value)) == value;
}

nlohmann::json packed(const std::vector<double>& values) {
  if (const auto ticks = as_ticks(values)) return *ticks;
  if (!std::all_of(values.begin(), values.end(), is_single))
    return {{"f64", base64(std::as_bytes(std::span(values)))}};
  const std::vector<float> singles(values.begin(), values.end());
  return {{"f32", base64(std::as_bytes(std::span(singles)))}};
}

}  // namespace

std::size_t PackedNumbers::add(const std::vector<double>& values) {
  nlohmann::json entry = packed(values);
  const auto [place, is_new] = known_.try_emplace(entry.dump(), lists_.size());
  if (is_new) lists_.push_back(std::move(entry));
  return place->second;
}

}  // namespace vibrissa::report
