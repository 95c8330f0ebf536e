#include "python/records.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "signals/base/decimal_point.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/files/column_choice.h"
#include "signals/files/dataset.h"
#include "signals/files/record_io.h"

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

signals::ReadOptions read_options(const std::map<std::string, std::string>& columns,
                                  const std::optional<double> rate_hz,
                                  const std::vector<std::string>& remove_mean) {
  signals::ReadOptions options;
  for (const auto& [channel, column] : columns)
    options.columns.push_back(signals::parse_column_choice(channel + "=" + column));
  options.sampling_rate_hz = rate_hz;
  options.remove_mean = remove_mean;
  return options;
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

// A function of a path and of how its files are read.
template <typename Read>
void add_reader(py::module_& module, const char* const name, const char* const path,
                const Read read, const char* const description) {
  module.def(
      name,
      [read](const std::filesystem::path& file, const std::map<std::string, std::string>& columns,
             const std::optional<double> sampling_rate_hz,
             const std::vector<std::string>& remove_mean) {
        return read(file, read_options(columns, sampling_rate_hz, remove_mean));
      },
      py::call_guard<signals::DecimalPoint>(), py::arg(path), py::kw_only(),
      py::arg("columns") = std::map<std::string, std::string>{},
      py::arg("sampling_rate_hz") = py::none(), py::arg("remove_mean") = std::vector<std::string>{},
      description);
}

}  // namespace

void add_records(py::module_& module) {
  add_record_class(module);
  add_reader(
      module, "read_record", "file", &signals::read_record,
      "Reads .csv, .mat, .h5, .npy, .uff or .wav. `columns` names the column and the unit of each "
      "channel,\nas in {'base_acceleration': 'ax[g]', 'base_moment': 'B[uT]*0.18[N m/T]'}.");
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
  add_reader(module, "read_dataset", "source", &signals::read_dataset,
             "Reads a folder of records, with or without dataset.json, or one record.");
}

}  // namespace vibrissa::python
