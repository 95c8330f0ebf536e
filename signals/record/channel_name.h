#pragma once

#include <string>
#include <vector>

namespace vibrissa::signals {

/// Channels of docs/records.md in the order in which a record is written; time_s last.
const std::vector<std::string>& known_channels();

inline const std::string time_channel = "time_s";

/// "base_acceleration" or "base_acceleration_m_s2" -> "base_acceleration_m_s2"; empty when no
/// channel has this name, with or without its unit. Proven by
/// tests/signals/files/column_choice_test.cc.
std::string full_channel_name(const std::string& name);

/// As full_channel_name, for a name from the user. Throws UserError that lists the known channels.
std::string known_channel(const std::string& name);

/// Unit of a known channel in the spelling of UDUNITS: "base_moment_N_m" -> "N m".
std::string unit_of_channel(const std::string& channel);

/// Whether the name ends in a unit ("hall_mT"). Names of measured quantities do; a text column or a
/// counter of a logger does not.
bool ends_with_unit(const std::string& name);

/// The ending behind the last underscores that is a unit: "mN_m" of "moment_mN_m"; empty: none.
std::string unit_at_the_end(const std::string& name);
/// Such an ending in the spelling of UDUNITS: "mN_m" -> "mN m", "m_s2" -> "m/s2"; of none, none.
std::string unit_of_ending(const std::string& ending);

}  // namespace vibrissa::signals
