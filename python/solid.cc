// Functions on case files, which need the solid. Records are passed as arrays and files, not as C++
// types, so that this module and _core share no types.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>

#include "case/case_overrides.h"
#include "case/inputs.h"
#include "case/rig.h"
#include "case/sensor_model.h"
#include "fem/linalg/solver_session.h"
#include "signals/base/decimal_point.h"
#include "signals/base/error.h"

namespace vibrissa::python {
namespace {

namespace py = pybind11;

// MPI starts and ends once in a process, for any number of calls.
std::optional<fem::SolverSession>& session() {
  static std::optional<fem::SolverSession> of_process;
  return of_process;
}

sensor_case::Case read_case(const std::string& file, const std::vector<std::string>& settings) {
  sensor_case::CaseOverrides options;
  options.case_file = file;
  options.settings = settings;
  // One list of settings serves both functions.
  options.use = sensor_case::CaseUse::record_and_model;
  return options.load().read();
}

// Rate, start and channels of the record that `vibrissa simulate` writes.
py::tuple simulate(const std::string& file, const std::vector<std::string>& settings) {
  sensor_case::Case parameters = read_case(file, settings);
  parameters.sensor.model.sensitivities = false;  // only a model file holds them
  sensor_case::check_reduced_wind(parameters);
  sensor_case::refuse_gravity(parameters, "the reduced model");
  const sensor_case::Inputs inputs = sensor_case::make_inputs(parameters);
  if (!session()) session().emplace();
  const fem::Sensor sensor(parameters.sensor);
  const auto model = sensor_case::make_reduced_model(sensor, parameters.sensor, false);
  const signals::Record record = sensor_case::measure_on_rig(model, parameters, inputs).both;
  py::dict channels;
  for (const std::string& name : record.channel_names()) {
    const auto values = record.channel(name);
    channels[py::str(name)] =
        py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
  }
  return py::make_tuple(record.sampling_rate_hz(), record.time_s(0), channels);
}

void write_model(const std::string& file, const std::vector<std::string>& settings,
                 const std::string& to) {
  const sensor_case::Case parameters = read_case(file, settings);
  sensor_case::refuse_gravity(parameters, "the reduced model");
  if (!session()) session().emplace();
  signals::write_reduced_model(to, sensor_case::make_reduced_model(fem::Sensor(parameters.sensor),
                                                                   parameters.sensor, false));
}

}  // namespace
}  // namespace vibrissa::python

PYBIND11_MODULE(_solid, module) {
  namespace py = pybind11;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const vibrissa::signals::UserError& error) {
      const auto kind = py::module_::import("vibrissa._core").attr("UserError");
      PyErr_SetString(kind.ptr(), error.what());
    }
  });
  py::module_::import("atexit").attr("register")(
      py::cpp_function([] { vibrissa::python::session().reset(); }));
  const py::call_guard<vibrissa::signals::DecimalPoint> plain;
  module.def("simulate", &vibrissa::python::simulate, plain, py::arg("case"), py::arg("settings"));
  module.def("write_model", &vibrissa::python::write_model, plain, py::arg("case"),
             py::arg("settings"), py::arg("to"));
}
