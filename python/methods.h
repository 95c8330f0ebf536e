#pragma once

#include <pybind11/pybind11.h>

namespace vibrissa::python {

/// Identification, separation, diagnosis and simulation by a model. Reports come as JSON texts, the
/// same that the program prints. Proven by tests/python/module_test.py.
void add_methods(pybind11::module_& module);

}  // namespace vibrissa::python
