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

// Endings of the names of measured columns, and their units for UDUNITS where these differ.
constexpr auto unit_endings = std::to_array<std::pair<std::string_view, std::string_view>>(
    {{"s", ""},           {"ms", ""},           {"us", ""},         {"Hz", ""},
     {"m", ""},           {"mm", ""},           {"um", ""},         {"m_s", "m/s"},
     {"mps", "m/s"},      {"mm_s", "mm/s"},     {"km_h", "km/h"},   {"kmh", "km/h"},
     {"m_s2", "m/s2"},    {"mps2", "m/s2"},     {"ms2", "m/s2"},    {"mm_s2", "mm/s2"},
     {"g", ""},           {"mg", ""},           {"rad", ""},        {"mrad", ""},
     {"deg", "degree"},   {"rad_s", "rad/s"},   {"radps", "rad/s"}, {"deg_s", "degree/s"},
     {"dps", "degree/s"}, {"rad_s2", "rad/s2"}, {"N", ""},          {"mN", ""},
     {"uN", ""},          {"N_m", "N.m"},       {"mN_m", "mN.m"},   {"uN_m", "uN.m"},
     {"Nm", "N.m"},       {"mNm", "mN.m"},      {"Nmm", "N.mm"},    {"mNmm", "mN.mm"},
     {"mN_mm", "mN.mm"},  {"uNm", "uN.m"},      {"Pa", ""},         {"hPa", ""},
     {"kPa", ""},         {"bar", ""},          {"A", ""},          {"mA", ""},
     {"V", ""},           {"mV", ""},           {"uV", ""},         {"T", ""},
     {"mT", ""},          {"uT", ""},           {"C", "degC"},      {"degC", ""},
     {"K", ""},           {"kg", ""},           {"kg_m3", "kg/m3"}, {"W", ""},
     {"percent", "%"}});

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
  return !unit_at_the_end(name).empty();
}

std::string unit_at_the_end(const std::string& name) {
  std::string_view longest;
  for (const auto& [ending, unit] : unit_endings)
    if (name.size() > ending.size() + 1 && name.ends_with(ending) &&
        name[name.size() - ending.size() - 1] == '_' && ending.size() > longest.size())
      longest = ending;
  return std::string(longest);
}

std::string unit_of_ending(const std::string& ending) {
  if (ending.empty()) return {};
  const auto found = std::find_if(unit_endings.begin(), unit_endings.end(),
                                  [&](const auto& known) { return known.first == ending; });
  assert(found != unit_endings.end());
  return std::string(found->second.empty() ? found->first : found->second);
}

}  // namespace vibrissa::signals
