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
};

struct Sources {
  std::vector<Source> channels;
  std::optional<Source> time;  // without it the clock is stated in the file or in the options
};

/// Finds which columns of a file become which channels. Throws UserError as read_record does for
/// columns that do not exist, are chosen twice, or are missing.
Sources find_sources(const formats::RecordTable& file, const ReadOptions& options);

}  // namespace vibrissa::signals
