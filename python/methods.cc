#include "python/methods.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <variant>

#include "diagnosis/diagnosis.h"
#include "diagnosis/model/updated_model.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "diagnosis/prediction/record_simulation.h"
#include "separation/filters/bvrm_separator.h"
#include "separation/identification/identify.h"
#include "separation/model/sampled_bvrm.h"
#include "separation/nonlinear/identify_nonlinear.h"
#include "separation/nonlinear/nonlinear_separator.h"
#include "separation/stream_methods.h"
#include "separation/verdict/identification_json.h"
#include "signals/base/decimal_point.h"
#include "signals/system/output_file.h"

namespace vibrissa::python {
namespace {

constexpr std::size_t whole_verdict = 1000;  // lines

namespace py = pybind11;
using separation::NonlinearBvrm;
using separation::SampledBvrm;
using signals::Record;

py::array_t<double> to_array(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

separation::IdentifyOptions identify_options(const std::optional<std::size_t> order,
                                             const std::size_t max_order,
                                             const std::size_t period_samples,
                                             const std::string& method,
                                             const std::optional<std::string>& hold,
                                             const bool direct_term) {
  separation::IdentifyOptions options;
  options.method = separation::parse_identify_method(method);
  options.order = order;
  options.max_order = max_order;
  options.period_samples = period_samples;
  if (hold) options.hold = separation::parse_hold(*hold);
  options.direct_term = direct_term;
  return options;
}

// Model and report of `vibrissa identify --nonlinear --json`.
std::pair<NonlinearBvrm, std::string> identify_nonlinear(
    const Record& record, const std::optional<Record>& held_out,
    const std::optional<std::size_t> order, const std::size_t max_order,
    const std::size_t period_samples, const std::string& method,
    const std::optional<std::string>& hold, const bool direct_term) {
  const auto found = separation::identify_nonlinear(
      record, held_out,
      identify_options(order, max_order, period_samples, method, hold, direct_term));
  return {found.fit.model, separation::nonlinear_report(found).dump()};
}

// Model and report of `vibrissa identify --json`.
std::pair<SampledBvrm, std::string> identify(
    const Record& record, const std::optional<Record>& held_out,
    const std::optional<std::size_t> order, const std::size_t max_order,
    const std::size_t period_samples, const std::string& method,
    const std::optional<std::string>& hold, const bool direct_term) {
  const separation::IdentifyOptions options =
      identify_options(order, max_order, period_samples, method, hold, direct_term);
  const auto [fit, scored] =
      held_out ? separation::SplitRecord{record, *held_out} : separation::hold_out_part(record);
  const auto found = held_out ? separation::identify_bvrm(fit, scored, options)
                              : separation::identify_record(record, options);
  const auto evidence = separation::examine(found, fit, scored);
  return {{found.fit.model, found.hold, evidence.verdict.stated()},
          separation::identification_report(found, evidence, method).dump()};
}

using AnyBvrm = std::variant<SampledBvrm, NonlinearBvrm>;

std::unique_ptr<separation::Separator> separator_of(const AnyBvrm& model, const double rate_hz,
                                                    const std::optional<separation::Hold>& told) {
  if (const auto* nonlinear = std::get_if<NonlinearBvrm>(&model))
    return std::make_unique<separation::NonlinearSeparator>(*nonlinear, rate_hz,
                                                            nonlinear->hold_or(told));
  const auto& bvrm = std::get<SampledBvrm>(model);
  return std::make_unique<separation::BvrmSeparator>(bvrm.model, rate_hz, bvrm.hold_or(told));
}

std::map<std::string, py::array_t<double>> separate(const Record& record,
                                                    const std::optional<AnyBvrm>& model,
                                                    const std::vector<std::string>& methods,
                                                    const std::size_t block, const std::size_t taps,
                                                    const std::optional<double> step,
                                                    const std::optional<std::string>& hold) {
  if (const auto* bvrm = model ? std::get_if<SampledBvrm>(&*model) : nullptr)
    if (const std::string warning = bvrm->warning(); !warning.empty())
      if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) != 0) throw py::error_already_set();
  std::map<std::string, std::vector<double>> found;
  {
    const py::gil_scoped_release released;
    if (model) {
      std::optional<separation::Hold> told;
      if (hold) told = separation::parse_hold(*hold);
      const auto bvrm = separator_of(*model, record.sampling_rate_hz(), told);
      found["bvrm"] = separation::separate_record(*bvrm, record);
    }
    separation::FdafOptions options = {block, taps, {}, {}, 0.};
    if (step) options.step.step = *step;
    for (const std::string& name : methods) {
      const auto separator = separation::stream_method(name).make(options);
      found[name] = separation::separate_record(*separator, record);
    }
  }
  std::map<std::string, py::array_t<double>> arrays;
  for (const auto& [name, values] : found) arrays[name] = to_array(values);
  return arrays;
}

// Model and the report that `vibrissa diagnose --json` prints, and its words.
struct Answer {
  diagnosis::UpdatedModel updated;
  std::string json, words;
};

Answer diagnose(const diagnosis::UpdatedModel& simulation, const signals::Dataset& real,
                const std::size_t max_effects, const double simulated_rate_hz,
                const std::vector<std::string>& possible_experiments) {
  diagnosis::DiagnoseOptions options;
  options.search.max_effects = max_effects;
  options.simulated_rate_hz = simulated_rate_hz;
  options.possible_experiments = possible_experiments;
  const diagnosis::Diagnosis found = diagnosis::diagnose(simulation, real, options);
  return {found.updated, diagnosis::diagnosis_json(found),
          diagnosis::verdict_text(found, whole_verdict)};
}

// A reduced model or an updated model.
diagnosis::UpdatedModel read_model(const std::filesystem::path& file) {
  if (diagnosis::is_updated_model(file)) return diagnosis::read_updated_model(file);
  return diagnosis::nominal_from(signals::read_reduced_model(file));
}

py::array_t<double> simulate(const diagnosis::UpdatedModel& model, const Record& inputs,
                             const bool periodic) {
  std::vector<double> moment;
  {
    const py::gil_scoped_release released;
    moment = diagnosis::simulate_moment(
        model, inputs, periodic ? diagnosis::Start::periodic : diagnosis::Start::settled);
  }
  return to_array(moment);
}

void add_models(py::module_& module) {
  py::class_<SampledBvrm>(module, "Bvrm",
                          "Base vibration response model: base acceleration to base moment.")
      .def_static("read", &separation::read_bvrm, py::arg("file"))
      .def(
          "write",
          [](const SampledBvrm& model, const std::filesystem::path& file) {
            separation::write_bvrm(file, model);
          },
          py::arg("file"))
      .def(
          "response",
          [](const SampledBvrm& model, const std::vector<double>& frequency_hz) {
            const auto values = separation::response(model.model, frequency_hz);
            return py::array_t<std::complex<double>>(static_cast<py::ssize_t>(values.size()),
                                                     values.data());
          },
          py::arg("frequency_hz"),
          "Frequency response, base moment over base acceleration [kg m]; time convention exp(+j w "
          "t).")
      .def_property_readonly(
          "json", [](const SampledBvrm& model) { return separation::to_json(model).dump(); });
  py::class_<NonlinearBvrm>(module, "NonlinearBvrm",
                            "Base vibration response model with the law of the joint.")
      .def_static("read", &separation::read_nonlinear_bvrm, py::arg("file"))
      .def(
          "write",
          [](const NonlinearBvrm& model, const std::filesystem::path& file) {
            separation::write_nonlinear_bvrm(file, model);
          },
          py::arg("file"))
      .def_property_readonly(
          "json", [](const NonlinearBvrm& model) { return separation::to_json(model).dump(); });
  py::class_<diagnosis::UpdatedModel>(
      module, "Model", "Simulation of the sensor: a nominal model with known effects.")
      .def_static("read", &read_model, py::arg("file"), "Reads model.json or updated_model.json.")
      .def_static(
          "from_records",
          [](const signals::Dataset& simulated) {
            return diagnosis::UpdatedModel(diagnosis::identify_nominal(simulated));
          },
          py::arg("simulated"), "Identifies the nominal model from simulated records.")
      .def(
          "write",
          [](const diagnosis::UpdatedModel& model, const std::filesystem::path& file) {
            signals::write_file(
                file, [&](std::ostream& out) { out << diagnosis::updated_model_json(model); });
          },
          py::arg("file"))
      .def("simulate", &simulate, py::arg("inputs"), py::kw_only(), py::arg("periodic") = false,
           "Simulates the base moment [N m] for the base acceleration and wind speed of a record, "
           "without noise.");
}

}  // namespace

void add_methods(py::module_& module) {
  add_models(module);
  const py::call_guard<signals::DecimalPoint> plain;
  const py::call_guard<py::gil_scoped_release, signals::DecimalPoint> without_lock;
  module.def("identify", &identify, without_lock, py::arg("record"), py::arg("held_out"),
             py::arg("order"), py::arg("max_order"), py::arg("period_samples"), py::arg("method"),
             py::arg("hold"), py::arg("direct_term"));
  module.def("identify_nonlinear", &identify_nonlinear, without_lock, py::arg("record"),
             py::arg("held_out"), py::arg("order"), py::arg("max_order"), py::arg("period_samples"),
             py::arg("method"), py::arg("hold"), py::arg("direct_term"));
  module.def("separate", &separate, plain, py::arg("record"), py::arg("model"), py::arg("methods"),
             py::arg("block"), py::arg("taps"), py::arg("step"), py::arg("hold"));
  py::class_<Answer>(module, "Answer")
      .def_readonly("updated", &Answer::updated)
      .def_readonly("json", &Answer::json)
      .def_readonly("words", &Answer::words);
  module.def("diagnose", &diagnose, without_lock, py::arg("simulation"), py::arg("real"),
             py::arg("max_effects"), py::arg("simulated_rate_hz"), py::arg("possible_experiments"));
}

}  // namespace vibrissa::python
