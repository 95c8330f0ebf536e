#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "signals/files/record_io.h"

namespace vibrissa::python {

namespace py = pybind11;

/// How a file is read, as the commands' options say it.
struct FileOptions {
  std::map<std::string, std::string> columns{};  // channel: column
  std::optional<double> sampling_rate_hz{};
  std::vector<std::string> remove_mean{};
  std::string gaps = "pieces";
  std::optional<double> resample_hz{};
  std::optional<std::pair<std::size_t, std::size_t>> rows{};  // first and last

  /// Throws UserError for a word or a range that is none.
  signals::ReadOptions read_options() const;
};

/// Record, Dataset, and functions that read and write them.
void add_records(py::module_& module);

}  // namespace vibrissa::python
