#include "separation/model/input_hold.h"

#include <array>
#include <numbers>
#include <utility>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

const std::array<std::pair<Hold, std::string>, 3> hold_names{
    {{Hold::first_order, "first_order"},
     {Hold::zero_order, "zero_order"},
     {Hold::band_limited, "band_limited"}}};

}  // namespace

std::string to_string(Hold hold) {
  for (const auto& [value, name] : hold_names)
    if (value == hold) return name;
  return {};
}

Hold parse_hold(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [value, text] : hold_names) {
    if (text == name) return value;
    known.push_back(text);
  }
  throw signals::UserError(signals::unknown_name("hold", name, known));
}

double highest_rad_s(Hold hold, double sampling_rate_hz) {
  const double half = std::numbers::pi * sampling_rate_hz;
  return hold == Hold::band_limited ? 2. * half : half;
}

}  // namespace vibrissa::separation
