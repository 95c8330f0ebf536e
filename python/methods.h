#pragma once

#include <pybind11/pybind11.h>

namespace vibrissa::python {

/// Identification, separation, diagnosis and simulation with a model. Reports are JSON texts, equal
/// to those of the program. Proven by tests/python/module_test.py.
void add_methods(pybind11::module_& module);

}  // namespace vibrissa::python
