#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "signals/files/record_io.h"
#include "signals/files/record_sources.h"
#include "signals/formats/record_table.h"

namespace vibrissa::signals {

/// Reads a record file block by block. Of a text file only one block is in memory, and
/// once the time stamps where they jitter; of other formats the whole file is. Lost samples are
/// refused. Each block is checked as in read_record, and must begin where the previous
/// block ended. Proven by tests/apps/stream_test.cc.
class RecordStream {
 public:
  /// Throws UserError as read_record does, and for options.remove_mean, which needs the whole
  /// record.
  explicit RecordStream(const std::filesystem::path& file, const ReadOptions& options = {});

  double sampling_rate_hz() const { return axis_.sampling_rate_hz; }
  double start_s() const { return axis_.start_s; }
  std::size_t n_samples() const { return n_rows_; }

  /// The next block; nothing after the last block. Throws UserError for samples that read_record
  /// would refuse.
  std::optional<Record> next();

 private:
  Record read(std::size_t first, std::size_t count) const;
  void find_axis();
  void check_joins(const Record& block, std::size_t first) const;

  std::filesystem::path file_;
  ReadOptions options_;
  std::unique_ptr<formats::RecordTable> table_;
  Sources sources_;
  std::size_t n_rows_ = 0, n_read_ = 0;
  TimeAxis axis_{0., 0.};
  bool is_from_all_stamps_ = false;  // they jitter, so a block alone does not tell the rate
};

}  // namespace vibrissa::signals
