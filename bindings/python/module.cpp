// The Python module `fathom`: the C++ interface with numpy arrays, which are read and written in place.
// Tested by: bindings/python/test_fathom.py
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <fathom/fathom.hpp>

#include "bindings/python/mesh.h"
#include "bindings/python/points.h"
#include "bindings/python/render.h"
#include "bindings/python/throw_error.h"

namespace py = pybind11;

namespace fathom::python {
namespace {

using Parameters = std::optional<py::dict>;

CompileOptions to_options(const Parameters& parameters) {
  CompileOptions options;
  if (!parameters) return options;
  for (const auto& [key, value] : *parameters) {
    if (!py::isinstance<py::str>(key)) throw py::type_error("parameters: a name is no str");
    const std::string name = py::str(key);
    options.parameters.emplace_back(name, to_number(value, "parameters['" + name + "']"));
  }
  return options;
}

SceneObject take(Compiled compiled) {
  if (compiled.error) throw_error(compiled.error, compiled.diagnostics);
  SceneObject scene{std::move(compiled.scene), std::move(compiled.diagnostics), {}};
  check(scene.scene.objects(scene.objects));
  return scene;
}

SceneObject compile_text(const std::string& text, const Parameters& parameters, const std::string& name,
                         const py::object& folder) {
  CompileOptions options = to_options(parameters);
  options.name = name;
  options.folder = to_path(folder);
  Compiled compiled;
  {
    const py::gil_scoped_release release;
    compiled = compile(text, options);
  }
  return take(std::move(compiled));
}

SceneObject load_file(const py::object& path, const Parameters& parameters) {
  const std::string file = to_path(path);
  const CompileOptions options = to_options(parameters);
  Compiled compiled;
  {
    const py::gil_scoped_release release;
    compiled = load(file, options);
  }
  return take(std::move(compiled));
}

SceneObject unpack_scene(const std::string& bytes) {
  Compiled compiled;
  {
    const py::gil_scoped_release release;
    compiled = unpack(bytes);
  }
  return take(std::move(compiled));
}

// Pickles a scene without its warnings.
py::tuple reduce(const SceneObject& scene) {
  std::string bytes;
  check(scene.scene.pack(bytes));
  // Functions of this module cannot be pickled, and the class can.
  const py::object unpack = py::module_::import("operator").attr("methodcaller")("_unpack", py::bytes(bytes));
  return py::make_tuple(unpack, py::make_tuple(py::type::of<SceneObject>()));
}

py::dict parameters_of(const SceneObject& scene) {
  std::vector<Parameter> all;
  check(scene.scene.parameters(all));
  py::dict out;
  for (const Parameter& each : all) out[py::str(each.name)] = each.value;
  return out;
}

py::tuple bounds_of(const SceneObject& scene) {
  const Box box = scene.scene.bounds();
  const auto corner = [](Vec3d v) { return py::make_tuple(v.x, v.y, v.z); };
  return py::make_tuple(corner(box.lo), corner(box.hi));
}

std::string describe(const SceneObject& scene) {
  return "<fathom.Scene: " + std::to_string(scene.objects.size()) +
         (scene.objects.size() == 1 ? " object>" : " objects>");
}

void bind_diagnostics(py::module_& module) {
  py::class_<Diagnostic>(module, "Diagnostic", made_by_functions(), "An error or warning about a scene's text.")
      .def_property_readonly("severity", [](const Diagnostic& d) { return d.error ? "error" : "warning"; })
      .def_readonly("code", &Diagnostic::code, "such as 'E0102'")
      .def_readonly("message", &Diagnostic::message)
      .def_readonly("file", &Diagnostic::file)
      .def_readonly("line", &Diagnostic::line, "from 1; 0: about the scene as a whole")
      .def_readonly("column", &Diagnostic::column, "from 1, in code points")
      .def_property_readonly(
          "span", [](const Diagnostic& d) { return py::make_tuple(d.begin, d.end); },
          "first byte, and the byte after the last, in the file")
      .def_readonly("label", &Diagnostic::label)
      .def_readonly("help", &Diagnostic::help)
      .def("__str__", [](const Diagnostic& d) {
        return to_string({&d, 1});
      });
}

void bind_scene(py::module_& module) {
  py::class_<SceneObject>(module, "Scene", made_by_functions(),
                          "A compiled scene. It does not change, and any threads may use it at once.")
      .def("distance", &distance, py::arg("points"), py::arg("out") = py::none(),
           "Signed distances, scene units, of points of shape (..., 3): in float32 for float32 arrays, otherwise in\n"
           "float64. The result has shape (...), and is `out` if that is given.")
      .def("gradient", &gradient, py::arg("points"), py::arg("out") = py::none(),
           "Gradients of the distance at points of shape (..., 3), not normalised.")
      .def("nearest", &nearest, py::arg("points"),
           "Indices into `objects` of the objects nearest to points of shape (..., 3).")
      .def("range", &range, py::arg("lo"), py::arg("hi"),
           "Bounds (..., 2) of the distances in the boxes from lo (..., 3) to hi (..., 3).")
      .def("march", &march, py::arg("origins"), py::arg("directions"), py::arg("t_max") = py::none(),
           "Follows rays, given by arrays (..., 3), to the first surface. Returns Hits. A single origin or\n"
           "direction is that of all rays, as numpy broadcasts arrays.")
      .def("render", &render, py::kw_only(), py::arg("width") = py::none(), py::arg("height") = py::none(),
           py::arg("samples") = py::none(), py::arg("seed") = py::none(), py::arg("denoise") = false,
           py::arg("threads") = 0, py::arg("time_limit") = py::none(), py::arg("progress") = py::none(),
           "Renders the scene to an Image. Sizes in pixels and samples per pixel are the scene's unless given.\n"
           "progress(fraction) is called about 20 times a second; if it returns False, the image keeps the samples\n"
           "taken so far. time_limit is in seconds. Ctrl-C ends the render.")
      .def("mesh", &mesh, py::kw_only(), py::arg("tolerance") = py::none(), py::arg("resolution") = 256,
           py::arg("box") = py::none(), py::arg("simplify") = true, py::arg("threads") = 0,
           "Meshes the surface. Returns Mesh: a closed manifold of triangles, within `tolerance` of the surface or\n"
           "with `resolution` cells along the longest side. box = (lo, hi) cuts the solid off.")
      .def_readonly("objects", &SceneObject::objects, "names of the objects")
      .def_readonly("warnings", &SceneObject::warnings, "what the compiler warned about")
      .def_property_readonly("parameters", &parameters_of, "values of the scene's parameters by name")
      .def_property_readonly("bounds", &bounds_of, "corners of a box outside which there is no surface")
      .def_property_readonly(
          "lipschitz", [](const SceneObject& s) { return s.scene.lipschitz(); },
          "max change of the distance per unit of length")
      .def_property_readonly(
          "certified", [](const SceneObject& s) { return s.scene.certified(); }, "whether `lipschitz` is proved")
      .def("__reduce__", &reduce)
      .def_static("_unpack", &unpack_scene, py::arg("bytes"))
      .def("__repr__", &describe);
}

}  // namespace
}  // namespace fathom::python

PYBIND11_MODULE(fathom, module) {
  using namespace fathom::python;
  module.doc() = "Scenes of signed distance fields: compiled, evaluated, marched and rendered.";
  module.attr("__version__") = FATHOM_VERSION;
  module.attr("instruction_set") = fathom::instruction_set();
  bind_errors(module);
  bind_diagnostics(module);
  bind_scene(module);
  bind_render(module);
  bind_mesh(module);
  module.def(
      "compile", &compile_text, py::arg("text"), py::arg("parameters") = py::none(), py::kw_only(),
      py::arg("name") = "scene", py::arg("folder") = py::str(""),
      "Compiles a scene's text: the scene language, JSON or a model of another format. `parameters` maps names\n"
      "to values. `folder` is where imports are. Raises SceneError.");
  module.def("load", &load_file, py::arg("path"), py::arg("parameters") = py::none(),
             "Reads and compiles a scene file, or reads a compiled file (.fbc). Raises SceneError or OSError.");
}
