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

py::custom_type_setup made_by_functions() {
  return py::custom_type_setup([](PyHeapTypeObject* heap) {
    heap->ht_type.tp_new = [](PyTypeObject* type, PyObject*, PyObject*) -> PyObject* {
      PyErr_Format(PyExc_TypeError, "%s has no constructor: functions of the module and methods return it",
                   type->tp_name);
      return nullptr;
    };
  });
}

std::string to_path(const py::object& path) {
  return py::cast<std::string>(py::module_::import("os").attr("fsencode")(path));
}

double to_number(const py::handle& value, const std::string& name) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (!PyErr_Occurred()) return number;
  PyErr_Clear();
  throw py::type_error(name + " is no number");
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
