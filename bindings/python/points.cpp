#include "bindings/python/points.h"

#include <limits>

namespace py = pybind11;

namespace fathom::python {
namespace {

using Shape = std::vector<py::ssize_t>;

// An array of points, and the library's view of it. The array is the caller's where its layout allows that: x, y and
// z of all points at whole numbers of elements, at one distance.
template <class T>
struct PointArray {
  py::array_t<T> array;
  Shape shape;  // without the last axis
  Points<T> points;
};

bool is_float32(const py::object& object) {
  return py::isinstance<py::array>(object) &&
         py::reinterpret_borrow<py::array>(object).dtype().is(py::dtype::of<float>());
}

// True if one stride leads from each point to the next.
template <class T>
bool has_one_stride(const py::array_t<T>& array) {
  constexpr py::ssize_t kSize = sizeof(T);
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
    if (array.strides(axis) % kSize != 0) return false;
    if (axis + 2 < array.ndim() && array.strides(axis) != array.strides(axis + 1) * array.shape(axis + 1))
      return false;
  }
  return true;
}

template <class T>
PointArray<T> read_points(const py::object& object, const char* name) {
  auto array = py::array_t<T, py::array::forcecast>::ensure(object);
  if (!array) throw py::type_error(std::string(name) + " is no array of numbers");
  if (array.ndim() < 1 || array.shape(array.ndim() - 1) != 3) {
    throw py::value_error(std::string(name) + " has no last axis of length 3: x, y, z");
  }
  if (!has_one_stride<T>(array)) array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(object);
  const Shape shape(array.shape(), array.shape() + array.ndim() - 1);
  constexpr py::ssize_t kSize = sizeof(T);
  const T* const first = array.data();
  const py::ssize_t between = array.strides(array.ndim() - 1) / kSize;
  const py::ssize_t stride = array.ndim() == 1 ? 3 : array.strides(array.ndim() - 2) / kSize;
  const auto count = static_cast<std::size_t>(array.size() / 3);
  return {array, shape, {first, first + between, first + 2 * between, count, stride}};
}

// Returns `out` if it is given and fits, otherwise a new array.
template <class T>
py::array_t<T> result_array(const py::object& out, const Shape& shape) {
  if (out.is_none()) return py::array_t<T>(shape);
  if (!py::isinstance<py::array>(out)) throw py::type_error("out is no array");
  const auto array = py::reinterpret_borrow<py::array>(out);
  const bool fits = array.dtype().is(py::dtype::of<T>()) && (array.flags() & py::array::c_style) &&
                    array.writeable() && Shape(array.shape(), array.shape() + array.ndim()) == shape;
  if (!fits) throw py::value_error("out has not the shape and type of the result, or cannot be written in order");
  return py::reinterpret_borrow<py::array_t<T>>(out);
}

// Lets other Python threads run while the library works.
template <class Work>
void run(Work&& work) {
  Error error;
  {
    const py::gil_scoped_release release;
    error = work();
  }
  check(error);
}

template <class T>
py::array distance_of(const Scene& scene, const py::object& object, const py::object& out) {
  const PointArray<T> in = read_points<T>(object, "points");
  auto result = result_array<T>(out, in.shape);
  const std::span<T> values(result.mutable_data(), in.points.count);
  run([&] { return scene.distance(in.points, values); });
  return result;
}

template <class T>
py::array gradient_of(const Scene& scene, const py::object& object, const py::object& out) {
  const PointArray<T> in = read_points<T>(object, "points");
  Shape shape = in.shape;
  shape.push_back(3);
  auto result = result_array<T>(out, shape);
  const std::span<Vec3<T>> values(reinterpret_cast<Vec3<T>*>(result.mutable_data()), in.points.count);
  run([&] { return scene.gradient(in.points, values); });
  return result;
}

template <class T>
py::array nearest_of(const Scene& scene, const py::object& object) {
  const PointArray<T> in = read_points<T>(object, "points");
  py::array_t<std::uint32_t> result(in.shape);
  Values<T> values;
  values.object = {result.mutable_data(), in.points.count};
  run([&] { return scene.evaluate(in.points, values); });
  return result;
}

template <class T>
Vec3d point_at(const Points<T>& points, std::size_t i) {
  const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * points.stride;
  return {points.x[at], points.y[at], points.z[at]};
}

// Reads two arrays of points, repeated to one shape as numpy broadcasts them.
std::pair<PointArray<double>, PointArray<double>> read_both(const py::object& a, const py::object& b,
                                                            const char* name_a, const char* name_b) {
  auto first = read_points<double>(a, name_a), second = read_points<double>(b, name_b);
  if (first.shape == second.shape) return {first, second};
  try {
    const py::list both = py::module_::import("numpy").attr("broadcast_arrays")(first.array, second.array);
    return {read_points<double>(both[0], name_a), read_points<double>(both[1], name_b)};
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError)) throw;
    throw py::value_error(std::string(name_a) + " and " + name_b + " differ in shape");
  }
}

std::vector<Ray> read_rays(const PointArray<double>& origins, const PointArray<double>& directions,
                           const py::object& t_max) {
  std::optional<double> limit;
  if (!t_max.is_none()) limit = to_number(t_max, "t_max");
  std::vector<Ray> rays(origins.points.count);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = {point_at(origins.points, i), point_at(directions.points, i), limit};
  }
  return rays;
}

// Copies a member of each hit to an array of `shape` and, for vectors, three.
template <class T, class Get>
py::array column(const std::vector<Hit>& hits, const Shape& shape, Get get) {
  py::array_t<T> out(shape);
  T* to = out.mutable_data();
  for (const Hit& hit : hits) *to++ = static_cast<T>(get(hit));
  return out;
}
template <class Get>
py::array vectors(const std::vector<Hit>& hits, Shape shape, Get get) {
  shape.push_back(3);
  py::array_t<double> out(shape);
  double* to = out.mutable_data();
  for (const Hit& hit : hits) {
    const Vec3d v = get(hit);
    *to++ = v.x;
    *to++ = v.y;
    *to++ = v.z;
  }
  return out;
}

}  // namespace

Box read_box(const py::object& object, const char* name) {
  const auto corners = read_points<double>(object, name);
  if (corners.shape != Shape{2}) throw py::value_error(std::string(name) + " is no pair of corners (lo, hi)");
  return {point_at(corners.points, 0), point_at(corners.points, 1)};
}

py::array distance(const SceneObject& scene, const py::object& points, const py::object& out) {
  return is_float32(points) ? distance_of<float>(scene.scene, points, out)
                            : distance_of<double>(scene.scene, points, out);
}

py::array gradient(const SceneObject& scene, const py::object& points, const py::object& out) {
  return is_float32(points) ? gradient_of<float>(scene.scene, points, out)
                            : gradient_of<double>(scene.scene, points, out);
}

py::array nearest(const SceneObject& scene, const py::object& points) {
  return is_float32(points) ? nearest_of<float>(scene.scene, points) : nearest_of<double>(scene.scene, points);
}

py::array range(const SceneObject& scene, const py::object& lo, const py::object& hi) {
  const auto [low, high] = read_both(lo, hi, "lo", "hi");
  std::vector<Box> boxes(low.points.count);
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = {point_at(low.points, i), point_at(high.points, i)};
  Shape shape = low.shape;
  shape.push_back(2);
  py::array_t<double> result(shape);
  const std::span<Interval> values(reinterpret_cast<Interval*>(result.mutable_data()), boxes.size());
  run([&] { return scene.scene.range(boxes, values); });
  return result;
}

py::object march(const SceneObject& scene, const py::object& origins, const py::object& directions,
                 const py::object& t_max) {
  const auto [from, along] = read_both(origins, directions, "origins", "directions");
  const std::vector<Ray> rays = read_rays(from, along, t_max);
  std::vector<Hit> hits(rays.size());
  run([&] { return scene.scene.march(rays, hits); });
  return py::module_::import("fathom").attr("Hits")(
      column<bool>(hits, from.shape, [](const Hit& h) { return h.hit; }),
      column<double>(hits, from.shape,
                     [](const Hit& h) { return h.hit ? h.t : std::numeric_limits<double>::infinity(); }),
      vectors(hits, from.shape, [](const Hit& h) { return h.position; }),
      vectors(hits, from.shape, [](const Hit& h) { return h.normal; }),
      column<std::uint32_t>(hits, from.shape, [](const Hit& h) { return h.object; }),
      column<bool>(hits, from.shape, [](const Hit& h) { return h.inside; }));
}

}  // namespace fathom::python
