#pragma once

#include <optional>
#include <string>
#include <vector>

#include "signals/files/record_io.h"
#include "signals/formats/record_table.h"

namespace vibrissa::signals {

/// A column of a file that becomes a channel: value = scale * column + offset.
struct Source {
  std::string channel;
  std::size_t column;
  double scale = 1.;
  double offset = 0.;
  std::string unit = {};    // that the file states and the scale converts
  bool keeps_unit = false;  // the values are in it, for it measures another quantity
};

struct Sources {
  std::vector<Source> channels;
  std::optional<Source> time;  // without it the clock is stated in the file or in the options
  bool time_unit_is_unknown = false;   // then times with fractions are in seconds
  bool time_is_beside_rate = false;    // found by its name although a rate is given
  std::string ignored_time_unit = {};  // of a column of dates, which have none
};

/// Finds which columns of a file become which channels, and converts the units that the file
/// states. Throws UserError as read_record does for columns that do not exist, are chosen twice, or
/// are missing, and for units that do not measure what the channel does.
Sources find_sources(const formats::RecordTable& file, const ReadOptions& options);

/// "base_acceleration_m_s2 = ax [g] * 9.80665, base_moment_N_m = M".
std::string to_string(const Sources& sources, const formats::RecordTable& file);

}  // namespace vibrissa::signals
