// Meshes for Python.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <utility>

#include "bindings/python/throw_error.h"

namespace fathom::python {

using Corner = std::array<double, 3>;

// See the documentation strings of the module.
pybind11::object mesh(const SceneObject& scene, std::optional<double> tolerance, int resolution,
                      std::optional<std::pair<Corner, Corner>> box, bool simplify, int threads);

// Adds the class Mesh.
void bind_mesh(pybind11::module_& module);

}  // namespace fathom::python
