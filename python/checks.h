#pragma once

#include <pybind11/pybind11.h>

namespace vibrissa::python {

namespace py = pybind11;

/// check_file and check_record: JSON and text of `vibrissa check`.
void add_checks(py::module_& module);

}  // namespace vibrissa::python
