// The Python module without the solid; it needs no deal.II. Users import vibrissa/__init__.py.
#include <pybind11/pybind11.h>

#include "diagnosis/diagnosis.h"
#include "python/checks.h"
#include "python/methods.h"
#include "python/records.h"
#include "signals/base/error.h"

PYBIND11_MODULE(_core, module) {
  namespace py = pybind11;
  py::register_exception<vibrissa::signals::UserError>(module, "UserError", PyExc_ValueError);
  py::register_exception<vibrissa::signals::ResourceError>(module, "ResourceError", PyExc_OSError);
  py::register_exception<vibrissa::diagnosis::TooLittleData>(module, "TooLittleData",
                                                             PyExc_RuntimeError);
  vibrissa::python::add_records(module);
  vibrissa::python::add_methods(module);
  vibrissa::python::add_checks(module);
}
