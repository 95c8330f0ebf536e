#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "signals/files/record_io.h"
#include "signals/files/record_sources.h"
#include "signals/formats/record_table.h"
#include "signals/record/clock.h"
#include "signals/record/record.h"

namespace vibrissa::signals {

inline constexpr std::size_t least_samples = 64;

/// Throws UserError for a rate that is not a positive number.
void check(const ReadOptions& options);

/// Number of rows that the options request. Throws UserError when the file has fewer rows, or when
/// the rows are too few for a record.
std::size_t number_of_rows(const formats::RecordTable& file, const ReadOptions& options);

/// The clock of n_rows rows from options.first_row on; path is the file name in messages. Throws
/// UserError as read_recording does.
Clock read_clock(const formats::RecordTable& file, const std::string& path, const Sources& sources,
                 const ReadOptions& options, std::size_t n_rows);

/// The records of these rows, one for each piece of the clock that is long enough, converted and
/// checked as in read_recording. Without a clock it is read from the same rows.
std::vector<Record> read_rows(const formats::RecordTable& file, const std::string& path,
                              const Sources& sources, const ReadOptions& options,
                              std::size_t n_rows, std::optional<Clock>& clock);

}  // namespace vibrissa::signals
