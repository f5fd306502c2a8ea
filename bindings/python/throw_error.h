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

// Setup of a class whose objects come from functions alone. pybind11 would let T.__new__(T) make one without
// contents.
pybind11::custom_type_setup made_by_functions();

// Returns a path, given as str, bytes or os.PathLike, as the system writes it.
std::string to_path(const pybind11::object& path);

// Returns the number, or raises TypeError, which names it.
double to_number(const pybind11::handle& value, const std::string& name);

// Throws the exception of an error: SceneError, ValueError, OSError, MemoryError or RuntimeError.
[[noreturn]] void throw_error(const Error& error, std::span<const Diagnostic> diagnostics = {});

inline void check(const Error& error) {
  if (error) throw_error(error);
}

}  // namespace fathom::python
