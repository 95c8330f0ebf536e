#pragma once

#include <pybind11/pybind11.h>

namespace vibrissa::python {

namespace py = pybind11;

/// Record, Dataset, and functions that read and write them.
void add_records(py::module_& module);

}  // namespace vibrissa::python
