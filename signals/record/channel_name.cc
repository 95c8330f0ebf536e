#include "signals/record/channel_name.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <string_view>
#include <utility>

#include "signals/base/error.h"
#include "signals/record/record.h"

namespace vibrissa::signals {
namespace {

// Endings of the names of known channels, and their units for UDUNITS. Longer endings come first.
constexpr auto known_ends =
    std::to_array<std::pair<std::string_view, std::string_view>>({{"_m_s2", "m/s2"},
                                                                  {"_m_s", "m/s"},
                                                                  {"_N_m", "N m"},
                                                                  {"_A", "A"},
                                                                  {"_C", "degC"},
                                                                  {"_s", "s"}});

}  // namespace

const std::vector<std::string>& known_channels() {
  static const std::vector<std::string> names = {channel::base_acceleration,
                                                 channel::cross_acceleration,
                                                 channel::wind_speed,
                                                 channel::base_moment,
                                                 channel::cross_moment,
                                                 "base_acceleration_2_m_s2",
                                                 "coil_current_A",
                                                 "temperature_C",
                                                 time_channel};
  return names;
}

std::string full_channel_name(const std::string& name) {
  for (const std::string& known : known_channels()) {
    if (known == name) return known;
    for (const auto& [end, unit] : known_ends)
      if (known == name + std::string(end)) return known;
  }
  return {};
}

std::string known_channel(const std::string& name) {
  const std::string channel = full_channel_name(name);
  if (channel.empty()) throw UserError(unknown_name("channel", name, known_channels()));
  return channel;
}

std::string unit_of_channel(const std::string& channel) {
  for (const auto& [end, unit] : known_ends)
    if (channel.ends_with(end)) return std::string(unit);
  assert(false && "every known channel ends in a unit");
  return "1";
}

bool ends_with_unit(const std::string& name) {
  static constexpr auto units = std::to_array<std::string_view>(
      {"s",     "ms",    "us",    "Hz",    "m",      "mm",     "um",  "m_s",  "mps",
       "mm_s",  "m_s2",  "mps2",  "mm_s2", "g",      "mg",     "rad", "mrad", "deg",
       "rad_s", "radps", "deg_s", "dps",   "rad_s2", "N",      "mN",  "uN",   "N_m",
       "mN_m",  "uN_m",  "Nm",    "mNm",   "Nmm",    "uNm",    "Pa",  "hPa",  "kPa",
       "bar",   "A",     "mA",    "V",     "mV",     "uV",     "T",   "mT",   "uT",
       "C",     "K",     "kg",    "kg_m3", "W",      "percent"});
  return std::any_of(units.begin(), units.end(), [&](const std::string_view unit) {
    return name.size() > unit.size() + 1 && name.ends_with(unit) &&
           name[name.size() - unit.size() - 1] == '_';
  });
}

}  // namespace vibrissa::signals
