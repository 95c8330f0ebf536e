#include "python/records.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "signals/base/decimal_point.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/files/column_choice.h"
#include "signals/files/dataset.h"
#include "signals/files/record_io.h"
#include "signals/formats/numeric_table.h"
#include "signals/record/channel_name.h"

namespace vibrissa::python {
namespace {

using signals::Record;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

Array to_array(const std::span<const double> values) {
  return Array(static_cast<py::ssize_t>(values.size()), values.data());
}

std::vector<double> to_vector(const Array& array) {
  if (array.ndim() != 1) throw signals::UserError("a channel must be an array of one dimension");
  return {array.data(), array.data() + array.size()};
}

Record make_record(const double sampling_rate_hz, const std::map<std::string, Array>& channels,
                   const double start_s) {
  if (channels.empty()) throw signals::UserError("a record needs at least one channel");
  Record record(sampling_rate_hz, static_cast<std::size_t>(channels.begin()->second.size()),
                start_s);
  for (const auto& [name, values] : channels) record.set_channel(name, to_vector(values));
  return record;
}

using Columns = std::vector<std::pair<std::string, Array>>;

/// A recording of columns in memory, with the clock and the units of a file.
signals::Recording recording_of(const std::optional<Array>& time, const Columns& columns,
                                const std::map<std::string, std::string>& units,
                                const FileOptions& given) {
  std::vector<signals::formats::NumericColumn> numbers;
  const auto add = [&](const std::string& name, const Array& values, const std::string& unit) {
    numbers.push_back({.name = name, .values = to_vector(values), .unit = unit});
    if (numbers.back().values.size() != numbers.front().values.size())
      throw signals::UserError("column '" + name + "' has " +
                               std::to_string(numbers.back().values.size()) + " values, '" +
                               numbers.front().name + "' has " +
                               std::to_string(numbers.front().values.size()));
  };
  const auto unit_of = [&](const std::string& name, const std::string& otherwise) {
    const auto found = units.find(name);
    return found == units.end() ? otherwise : found->second;
  };
  if (columns.empty()) throw signals::UserError("a record needs at least one column");
  for (const auto& [name, unit] : units)
    if (name != "time" &&
        std::ranges::none_of(columns, [&](const auto& column) { return column.first == name; }))
      throw signals::UserError("units name '" + name + "', but no column has this name");
  if (time) add("time", *time, unit_of("time", "s"));
  signals::ReadOptions options = given.read_options();
  const bool takes_all = options.columns.empty();
  for (const auto& [name, values] : columns) {
    add(name, values, unit_of(name, ""));
    // Where no unit is given the values are in SI, as on the command line.
    const std::string known = signals::full_channel_name(name);
    if (takes_all && (known.empty() || (known != name && unit_of(name, "").empty())))
      options.columns.push_back({.channel = known.empty() ? name : known, .column = name});
  }
  if (time)
    options.columns.push_back(
        signals::parse_column_choice("time=time[" + unit_of("time", "s") + "]"));
  signals::formats::NumericTable table("arrays", std::move(numbers));
  return signals::read_recording(table, "arrays", options);
}

void add_record_class(py::module_& module) {
  py::class_<Record>(module, "Record",
                     "Uniformly sampled channels on one clock, in SI units: sample i is at\n"
                     "start_s + i / sampling_rate_hz. Channel names end in their unit.")
      .def(py::init(&make_record), py::arg("sampling_rate_hz"), py::arg("channels"),
           py::arg("start_s") = 0.)
      .def_property_readonly("sampling_rate_hz", &Record::sampling_rate_hz)
      .def_property_readonly("start_s", [](const Record& record) { return record.time_s(0); })
      .def_property_readonly("duration_s", &Record::duration_s)
      .def_property_readonly("channel_names", &Record::channel_names)
      .def_property_readonly("time_s",
                             [](const Record& record) {
                               Array times(static_cast<py::ssize_t>(record.n_samples()));
                               for (std::size_t i = 0; i < record.n_samples(); ++i)
                                 times.mutable_data()[i] = record.time_s(i);
                               return times;
                             })
      .def("__len__", &Record::n_samples)
      .def("__contains__", &Record::has)
      .def("__getitem__", [](const Record& record,
                             const std::string& name) { return to_array(record.channel(name)); })
      .def("__repr__", [](const Record& record) {
        std::string text = "Record(" + std::to_string(record.n_samples()) + " samples at " +
                           signals::to_text(record.sampling_rate_hz()) + " Hz:";
        for (const std::string& name : record.channel_names()) text.append(" ").append(name);
        return text + ")";
      });
}

using Pieces = std::pair<std::vector<Record>, std::string>;

// The records between losses, and how they were read.
Pieces pieces_of(const signals::Recording& recording) {
  return {recording.pieces, recording.words};
}

FileOptions make_options(const std::map<std::string, std::string>& columns,
                         const std::optional<double> sampling_rate_hz,
                         const std::vector<std::string>& remove_mean, const std::string& gaps,
                         const std::optional<double> resample_hz,
                         const std::optional<std::pair<std::size_t, std::size_t>>& rows) {
  return {columns, sampling_rate_hz, remove_mean, gaps, resample_hz, rows};
}

void add_options_class(py::module_& module) {
  py::class_<FileOptions>(module, "FileOptions")
      .def(py::init(&make_options), py::kw_only(),
           py::arg("columns") = std::map<std::string, std::string>{},
           py::arg("sampling_rate_hz") = py::none(),
           py::arg("remove_mean") = std::vector<std::string>{}, py::arg("gaps") = "pieces",
           py::arg("resample_hz") = py::none(), py::arg("rows") = py::none());
}

}  // namespace

signals::ReadOptions FileOptions::read_options() const {
  signals::ReadOptions options;
  for (const auto& [channel, column] : columns)
    options.columns.push_back(signals::parse_column_choice(channel + "=" + column));
  options.sampling_rate_hz = sampling_rate_hz;
  options.remove_mean = remove_mean;
  if (gaps != "pieces" && gaps != "refuse")
    throw signals::UserError(signals::unknown_name("gaps", gaps, {"pieces", "refuse"}));
  options.gaps = gaps == "pieces" ? signals::Gaps::pieces : signals::Gaps::refuse;
  options.resample_hz = resample_hz;
  if (!rows) return options;
  if (rows->first == 0 || rows->second < rows->first)
    throw signals::UserError("rows must be (first, last), counted from 1");
  options.first_row = rows->first;
  options.n_rows = rows->second - rows->first + 1;
  return options;
}

void add_records(py::module_& module) {
  add_record_class(module);
  add_options_class(module);
  module.def(
      "read_recording",
      [](const std::filesystem::path& file, const FileOptions& options) {
        return pieces_of(signals::read_recording(file, options.read_options()));
      },
      py::call_guard<signals::DecimalPoint>());
  module.def(
      "recording_of",
      [](const std::optional<Array>& time, const Columns& columns,
         const std::map<std::string, std::string>& units, const FileOptions& options) {
        return pieces_of(recording_of(time, columns, units, options));
      },
      py::call_guard<signals::DecimalPoint>());
  module.def(
      "write_record", &signals::write_record, py::call_guard<signals::DecimalPoint>(),
      py::arg("file"), py::arg("record"),
      "Writes .csv, .mat, .h5, .npy or .uff; the ending of the file name selects the format.");
  py::class_<signals::Dataset>(module, "Dataset",
                               "Records of one sensor, with the excitation of each record.")
      .def("__len__", [](const signals::Dataset& dataset) { return dataset.records.size(); })
      .def_property_readonly(
          "records",
          [](const signals::Dataset& dataset) {
            std::vector<std::pair<std::string, Record>> records;
            for (const auto& entry : dataset.records)
              records.emplace_back(entry.name, entry.record);
            return records;
          },
          "Pairs of name and record.")
      .def_readonly("guesses", &signals::Dataset::guesses,
                    "Assumptions that were made because no file states them.");
  module.def(
      "read_dataset",
      [](const std::filesystem::path& source, const FileOptions& options) {
        return signals::read_dataset(source, options.read_options());
      },
      py::call_guard<signals::DecimalPoint>());
}

}  // namespace vibrissa::python
