#include "bindings/python/throw_error.h"

#include <pybind11/stl.h>

namespace py = pybind11;

namespace fathom::python {
namespace {

PyObject* python_type(Error::Kind kind) {
  switch (kind) {
    case Error::Kind::BadArgument:
      return PyExc_ValueError;
    case Error::Kind::File:
      return PyExc_OSError;
    case Error::Kind::OutOfMemory:
      return PyExc_MemoryError;
    default:
      return PyExc_RuntimeError;
  }
}

py::object scene_error_type() { return py::module_::import("fathom").attr("SceneError"); }

}  // namespace

void bind_errors(py::module_& module) {
  const py::object type = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(
      "fathom.SceneError", "A scene has errors. `diagnostics` lists them, and the warnings.", PyExc_ValueError,
      nullptr));
  module.attr("SceneError") = type;
}

void throw_error(const Error& error, std::span<const Diagnostic> diagnostics) {
  if (error.kind == Error::Kind::BadScene) {
    const py::object type = scene_error_type();
    const py::object value = type(diagnostics.empty() ? error.message : to_string(diagnostics));
    value.attr("diagnostics") = std::vector<Diagnostic>(diagnostics.begin(), diagnostics.end());
    PyErr_SetObject(type.ptr(), value.ptr());
  } else {
    PyErr_SetString(python_type(error.kind), error.message.c_str());
  }
  throw py::error_already_set();
}

}  // namespace fathom::python
