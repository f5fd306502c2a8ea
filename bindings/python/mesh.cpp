#include "bindings/python/mesh.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "bindings/python/points.h"

namespace py = pybind11;

namespace fathom::python {
namespace {

// Copies rows of three numbers.
template <class T, class Row>
py::array rows_of(const std::vector<Row>& from) {
  static_assert(sizeof(Row) == 3 * sizeof(T));
  py::array_t<T> out(std::vector<py::ssize_t>{static_cast<py::ssize_t>(from.size()), 3});
  std::copy_n(reinterpret_cast<const T*>(from.data()), 3 * from.size(), out.mutable_data());
  return out;
}

py::list list_of(const std::vector<LostPart>& lost) {
  py::list out;
  for (const LostPart& part : lost) {
    out.append(py::make_tuple(py::make_tuple(part.place.x, part.place.y, part.place.z), part.thickness, part.object,
                              part.gap));
  }
  return out;
}

}  // namespace

py::object mesh(const SceneObject& scene, std::optional<double> tolerance, int resolution, const py::object& box,
                bool simplify, int threads) {
  MeshOptions options{tolerance, resolution, {}, simplify, threads};
  if (!box.is_none()) options.box = read_box(box, "box");
  Meshed made;
  {
    const py::gil_scoped_release release;
    made = scene.scene.mesh(options);
  }
  check(made.error);
  const Mesh& all = made.mesh;
  py::array_t<std::uint32_t> objects(static_cast<py::ssize_t>(all.objects.size()), all.objects.data());
  return py::module_::import("fathom").attr("Mesh")(rows_of<double>(all.vertices),
                                                    rows_of<std::uint32_t>(all.triangles), objects, all.bound,
                                                    all.proved, list_of(all.lost));
}

void bind_mesh(py::module_& module) {
  module.attr("Mesh") =
      py::module_::import("collections")
          .attr("namedtuple")("Mesh", "vertices triangles object bound proved lost", py::arg("module") = "fathom");
}

}  // namespace fathom::python
