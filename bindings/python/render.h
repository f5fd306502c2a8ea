// Renders for Python: images as numpy arrays.
#pragma once

#include <pybind11/numpy.h>

#include <optional>

#include "bindings/python/throw_error.h"

namespace fathom::python {

Image render(const SceneObject& scene, std::optional<int> width, std::optional<int> height,
             std::optional<int> samples, std::optional<std::uint64_t> seed, bool denoise, int threads,
             std::optional<double> time_limit, const pybind11::object& progress);

// Adds the classes Image and Hits.
void bind_render(pybind11::module_& module);

}  // namespace fathom::python
