#include "bindings/python/render.h"

#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <future>
#include <string>

namespace py = pybind11;

namespace fathom::python {
namespace {

using Shape = std::vector<py::ssize_t>;

// Calls progress(fraction) and looks for Ctrl-C. Returns false if the render is to end. Python's exceptions pass.
bool goes_on(const py::object& progress, double fraction) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (progress.is_none()) return true;
  const py::object result = progress(fraction);
  return result.is_none() || py::cast<bool>(py::bool_(result));
}

py::array_t<float> read_layer(const Image& image, Layer layer) {
  py::array_t<float> out(Shape{image.height(), image.width(), 3});
  check(image.read(layer, {out.mutable_data(), static_cast<std::size_t>(out.size())}));
  return out;
}

template <class T>
py::array_t<T> read_values(const Image& image, Shape shape, Error (Image::*read)(std::span<T>) const noexcept) {
  py::array_t<T> out(std::move(shape));
  check((image.*read)({out.mutable_data(), static_cast<std::size_t>(out.size())}));
  return out;
}

void save(const Image& image, const py::object& path) {
  const std::string file = to_path(path);
  Error error;
  {
    const py::gil_scoped_release release;
    error = image.write(file);
  }
  check(error);
}

}  // namespace

// The render runs in a thread of its own, so that this one can call Python meanwhile.
Image render(const SceneObject& scene, std::optional<int> width, std::optional<int> height,
             std::optional<int> samples, std::optional<std::uint64_t> seed, bool denoise, int threads,
             std::optional<double> time_limit, const py::object& progress) {
  if (!progress.is_none() && !PyCallable_Check(progress.ptr())) throw py::type_error("progress is no function");
  constexpr auto kInterval = std::chrono::milliseconds(50);
  std::atomic<double> fraction = 0;
  std::stop_source stop;
  RenderOptions options{width, height, samples, seed, time_limit, denoise, threads};
  options.progress = [&](double share) { fraction = share; };
  options.stop = stop.get_token();
  std::future<Rendered> future = std::async(std::launch::async, [&] { return scene.scene.render(options); });
  Rendered rendered;
  try {
    for (bool done = false; !done;) {
      {
        const py::gil_scoped_release release;
        done = future.wait_for(kInterval) == std::future_status::ready;
      }
      if (!done && !goes_on(progress, fraction)) stop.request_stop();
    }
    rendered = future.get();
  } catch (...) {
    stop.request_stop();
    const py::gil_scoped_release release;
    future.wait();
    throw;
  }
  check(rendered.error);
  if (!progress.is_none() && rendered.image.complete()) progress(1.0);
  return rendered.image;
}

void bind_render(py::module_& module) {
  module.attr("Hits") =
      py::module_::import("collections")
          .attr("namedtuple")("Hits", "hit t position normal object inside", py::arg("module") = "fathom");
  module.attr("NO_OBJECT") = Image::kNoObject;
  py::class_<Image>(module, "Image", made_by_functions(),
                    "A rendered image. Each array is made anew when it is read.")
      .def_property_readonly("width", &Image::width)
      .def_property_readonly("height", &Image::height)
      .def_property_readonly("complete", &Image::complete, "False if a stop or the time limit ended the render")
      .def_property_readonly("samples", &Image::samples, "number of samples over all pixels")
      .def_property_readonly(
          "radiance", [](const Image& i) { return read_layer(i, Layer::Radiance); },
          "linear sRGB, float32, (height, width, 3)")
      .def_property_readonly(
          "albedo", [](const Image& i) { return read_layer(i, Layer::Albedo); }, "of the first hit, linear sRGB")
      .def_property_readonly(
          "normal", [](const Image& i) { return read_layer(i, Layer::Normal); },
          "mean of the first hits' normals; 0 without a hit")
      .def_property_readonly(
          "position", [](const Image& i) { return read_layer(i, Layer::Position); },
          "of the first hit, scene units; 0 without a hit")
      .def_property_readonly(
          "depth",
          [](const Image& i) {
            return read_values<float>(i, {i.height(), i.width()}, &Image::read_depth);
          },
          "along the ray to the first hit, scene units, (height, width); 0 without a hit")
      .def_property_readonly(
          "object",
          [](const Image& i) {
            return read_values<std::uint32_t>(i, {i.height(), i.width()}, &Image::read_objects);
          },
          "index into Scene.objects of the first hit; NO_OBJECT without a hit")
      .def_property_readonly(
          "display",
          [](const Image& i) {
            return read_values<std::uint8_t>(i, {i.height(), i.width(), 3}, &Image::read_display);
          },
          "for a display: exposure and tone curve of the scene, sRGB encoded, uint8")
      .def(
          "_repr_png_",
          [](const Image& i) {
            std::vector<std::uint8_t> file;
            check(i.encode_png(file));
            return py::bytes(reinterpret_cast<const char*>(file.data()), file.size());
          },
          "How notebooks show the image.")
      .def("save", &save, py::arg("path"),
           "Writes the image in the format of the path's ending: png, jpg, bmp, exr, pfm or hdr.");
}

}  // namespace fathom::python
