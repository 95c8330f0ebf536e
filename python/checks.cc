#include "python/checks.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <nlohmann/json.hpp>

#include "checks/report_json.h"
#include "checks/report_text.h"
#include "python/records.h"
#include "signals/base/decimal_point.h"

namespace vibrissa::python {
namespace {

using Texts = std::pair<std::string, std::string>;

Texts texts_of(const checks::CheckResult& result) {
  return {checks::check_json(result).dump(), checks::check_text(result)};
}

}  // namespace

void add_checks(py::module_& module) {
  module.def(
      "check_file",
      [](const std::filesystem::path& source, const FileOptions& options) {
        return texts_of(checks::check_file(source, options.read_options()));
      },
      py::call_guard<signals::DecimalPoint>());
  module.def(
      "check_record",
      [](const signals::Record& record) { return texts_of(checks::check_one("record", record)); },
      py::call_guard<signals::DecimalPoint>());
}

}  // namespace vibrissa::python
