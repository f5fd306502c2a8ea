// Errors of the library as Python exceptions.
#pragma once

#include <pybind11/pybind11.h>

#include <fathom/fathom.hpp>
#include <span>

namespace fathom::python {

// A compiled scene with what Python shows of it.
struct SceneObject {
  Scene scene;
  std::vector<Diagnostic> warnings;
  std::vector<std::string> objects;
};

// Adds the class SceneError, whose attribute `diagnostics` lists errors and warnings.
void bind_errors(pybind11::module_& module);

// Throws the exception of an error: SceneError, ValueError, OSError, MemoryError or RuntimeError.
[[noreturn]] void throw_error(const Error& error, std::span<const Diagnostic> diagnostics = {});

inline void check(const Error& error) {
  if (error) throw_error(error);
}

}  // namespace fathom::python
