#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "checks/check_record.h"
#include "checks/serves.h"
#include "signals/files/record_io.h"

namespace vibrissa::checks {

/// All that `vibrissa check` tells of one file or dataset.
struct CheckResult {
  std::string source{};
  std::vector<std::string> guesses{};  // made while a dataset was read
  std::vector<RecordReport> records{};
  std::vector<signals::Record> samples{};  // of these records
  std::vector<Finding> of_dataset{};       // about all records together
  ServesTable serves{};
};

/// The records of one sensor.
CheckResult check_dataset(const std::string& source, const signals::Dataset& dataset);

/// One record: its last third is taken as held out, as the commands do.
CheckResult check_one(const std::string& source, const signals::Record& record,
                      const std::string& reading = "");

/// Reads and checks a record file (each piece between lost samples is a record), a folder of
/// records or its dataset.json. Without a choice of columns, and where no column is a channel, all
/// columns of numbers are read under their own names. Throws UserError as read_recording and
/// read_dataset do. Proven by tests/checks/check_file_test.cc.
CheckResult check_file(const std::filesystem::path& source, const signals::ReadOptions& options);

}  // namespace vibrissa::checks
