#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "signals/files/column_choice.h"
#include "signals/formats/record_table.h"
#include "signals/formats/text/table_layout.h"
#include "signals/record/record.h"

namespace vibrissa::signals {

/// What happens where samples are lost: an error, or each piece between losses is a record.
enum class Gaps { refuse, pieces };

/// How a record file is read. Rows are data rows, counted from 1 after the header line.
struct ReadOptions {
  std::vector<ColumnChoice> columns = {};  // empty: the columns with the names of docs/records.md
  std::optional<double> sampling_rate_hz = {};  // needed when the file contains no time
  std::size_t first_row = 1;
  std::optional<std::size_t> n_rows = {};
  std::vector<std::string> remove_mean = {};  // channels whose mean is removed
  formats::TextOptions text = {};             // of a text table
  Gaps gaps = Gaps::refuse;
  std::optional<double> resample_hz = {};  // uneven samples are estimated at this even rate
  bool skips_missing_columns = false;      // of the choice; another file may have them
  /// Where no column is a channel: all columns of numbers, under their own names.
  bool takes_all_columns = false;
  /// Of a dataset: entries of the kind response are read, too; otherwise they are refused.
  bool takes_responses = false;
  /// A channel whose chosen column may stay in its own unit, where this measures another quantity
  /// and the choice has no factor; otherwise this is refused.
  std::string keeps_unit_of = {};
};

/// How a file was read, in the words of Recording.
struct FileReading {
  std::string file, words;
};
/// "bench.csv: read as: commas, ..."
std::string to_string(const FileReading& reading);

/// The records of a file and how it was read.
struct Recording {
  std::vector<Record> pieces;  // in the order of the file; one where nothing is lost
  /// For the user: "semicolons, decimal commas, names in line 1; 500 Hz from 't'; 10000 samples,
  /// 20 s; base_acceleration_m_s2 = ax [g] * 9.80665".
  std::string words;
  /// Time since 1970 of time 0, where the file has dates [s]; 0: it has none.
  double epoch_s = 0.;
  std::string kept_unit = {};   // of ReadOptions::keeps_unit_of; empty: it was converted
  std::size_t longest() const;  // index of the piece with the most samples
};

/// Reads the records of a file of any format (formats/file_format.h). Without a choice of columns
/// it reads all columns that are known channels or end in a unit (hall_mT), with their own names,
/// and ignores the others, such as text. Units that the file states are converted. The clock is a
/// column of times (record/clock.h), or the rate that the file states. A rate that is given in
/// addition to a time column must agree with it to 0.1 % and is used then; without time the first
/// row of the file is at 0 s. Only the chosen rows are checked. Proven by
/// tests/signals/files/record_io_test.cc, tests/signals/formats/text_file_test.cc,
/// tests/signals/record/time_axis_test.cc and clock_test.cc. Throws UserError with file, line and
/// column for: a missing file or column, text that is not a number, NaN or infinity, lost samples
/// (unless they make pieces), uneven sampling, rows of unequal length, fewer than 64 samples, a
/// rate that contradicts the time, a unit that does not measure what the channel does, a missing
/// channel in remove_mean.
Recording read_recording(const std::filesystem::path& file, const ReadOptions& options = {});

/// The same for columns that are in memory or in an open file; name is used in messages. Proven by
/// tests/signals/files/record_io_test.cc.
Recording read_recording(formats::RecordTable& table, const std::string& name,
                         const ReadOptions& options = {});

/// The longest record of read_recording.
Record read_record(const std::filesystem::path& file, const ReadOptions& options = {});

/// Writes the record in the format of the file's ending: .mat (MATLAB 5), .h5 or .hdf5, .npy, .uff,
/// .unv or .uf58 (values with 13 digits), else CSV with the shortest texts that read back to the
/// same double. The file is complete or does not exist. Throws UserError as write_file does, and
/// for .wav.
void write_record(const std::filesystem::path& file, const Record& record);

}  // namespace vibrissa::signals
