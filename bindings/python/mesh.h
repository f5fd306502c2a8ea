// Meshes for Python.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

#include "bindings/python/throw_error.h"

namespace fathom::python {

// See the documentation strings of the module.
pybind11::object mesh(const SceneObject& scene, std::optional<double> tolerance, int resolution,
                      const pybind11::object& box, bool simplify, int threads);

// Adds the class Mesh.
void bind_mesh(pybind11::module_& module);

}  // namespace fathom::python
