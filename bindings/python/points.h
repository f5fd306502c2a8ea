// Evaluation of points and rays in numpy arrays.
#pragma once

#include <pybind11/numpy.h>

#include "bindings/python/throw_error.h"

namespace fathom::python {

// Reads an array (2, 3) of two corners.
Box read_box(const pybind11::object& object, const char* name);

// See the documentation strings of the module.
pybind11::array distance(const SceneObject& scene, const pybind11::object& points, const pybind11::object& out);
pybind11::array gradient(const SceneObject& scene, const pybind11::object& points, const pybind11::object& out);
pybind11::array nearest(const SceneObject& scene, const pybind11::object& points);
pybind11::array range(const SceneObject& scene, const pybind11::object& lo, const pybind11::object& hi);
pybind11::object march(const SceneObject& scene, const pybind11::object& origins, const pybind11::object& directions,
                       const pybind11::object& t_max);

}  // namespace fathom::python
