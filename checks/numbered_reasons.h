#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "checks/check_file.h"

namespace vibrissa::checks {

/// The reasons of all commands, each once, also where several records have it: the findings of the
/// records that are a reason, in the order of the records, then what concerns all records together.
/// They count from 1. Proven by
/// tests/checks/check_file_test.cc.
class NumberedReasons {
 public:
  explicit NumberedReasons(const CheckResult& result);

  /// Number of a finding of a record; nothing where no command is worse for it.
  std::optional<std::size_t> of_finding(std::size_t record, std::size_t finding) const;
  /// Whether an earlier record has this finding, too.
  bool is_repeated(std::size_t record, std::size_t finding) const;
  /// "[1] [3]"; empty for a command that works.
  std::string of_command(const CommandVerdict& verdict) const;
  bool is_reason(const std::string& sentence) const { return number_of(sentence) > 0; }
  /// Number and sentence of the reasons that are no finding of one record.
  const std::vector<std::pair<std::size_t, std::string>>& others() const { return others_; }

 private:
  struct Entry {
    std::string sentence;
    std::vector<std::string> with_name;                       // of each record that has it
    std::vector<std::pair<std::size_t, std::size_t>> places;  // record and finding, likewise
    bool is(const std::string& reason) const;
  };
  std::size_t number_of(const std::string& reason) const;  // 0: it is none

  std::vector<Entry> findings_;  // number 1, 2, ...
  std::vector<std::pair<std::size_t, std::string>> others_;
};

}  // namespace vibrissa::checks
