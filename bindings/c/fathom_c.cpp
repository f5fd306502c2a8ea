// The C interface over the C++ interface. Tested by: tests/bindings/c_interface_test.cpp
#include <fathom/fathom.h>

#include <algorithm>
#include <cstring>
#include <fathom/fathom.hpp>
#include <initializer_list>
#include <string>
#include <vector>

#include "bindings/cpp/guard.h"

struct fathom_scene {
  fathom::Scene scene;
  std::vector<std::string> objects;
};
struct fathom_image {
  fathom::Image image;
};
// A mesh with its arrays. fathom_make_mesh() returns a pointer to the first member.
struct OwnedMesh {
  fathom_mesh view;
  fathom::Mesh mesh;
};
struct fathom_diagnostics {
  std::vector<fathom::Diagnostic> all;
};

namespace {

using fathom::Error;

struct Pointer {
  const char* name;
  const void* value;
};

// Returns the error that the first of these arguments is NULL, which its function needs, or none.
Error check_given(std::initializer_list<Pointer> pointers) {
  return fathom::library::guard([&]() -> Error {
    for (const Pointer& each : pointers) {
      if (each.value == nullptr) return fathom::library::bad_argument(std::string(each.name) + " is NULL");
    }
    return {};
  });
}

// Copies the error to the caller and returns its kind. A cut message ends at a whole character.
int report(const Error& error, fathom_error* out) {
  if (out != nullptr) {
    out->kind = static_cast<int>(error.kind);
    std::size_t length = std::min(error.message.size(), sizeof out->message - 1);
    const auto continues = [&](std::size_t at) {
      return (static_cast<unsigned char>(error.message[at]) & 0xc0) == 0x80;
    };
    while (length > 0 && length < error.message.size() && continues(length)) --length;
    std::memcpy(out->message, error.message.data(), length);
    out->message[length] = '\0';
  }
  return static_cast<int>(error.kind);
}

template <class Work>
int call(fathom_error* error, Work&& work) noexcept {
  return report(fathom::library::guard(std::forward<Work>(work)), error);
}

Error to_options(const fathom_compile_options* options, fathom::CompileOptions& out) {
  if (options == nullptr) return {};
  if (options->name != nullptr) out.name = options->name;
  if (options->folder != nullptr) out.folder = options->folder;
  if (options->import_root != nullptr) out.import_root = options->import_root;
  out.memory = options->memory;
  if (options->parameter_count > 0) {
    if (Error error = check_given({{"options.parameters", options->parameters}})) return error;
  }
  for (std::size_t i = 0; i < options->parameter_count; ++i) {
    const std::string name = "options.parameters[" + std::to_string(i) + "].name";
    if (Error error = check_given({{name.c_str(), options->parameters[i].name}})) return error;
    out.parameters.emplace_back(options->parameters[i].name, options->parameters[i].value);
  }
  return {};
}

Error hand_over(fathom::Compiled compiled, fathom_scene** scene, fathom_diagnostics** diagnostics) {
  auto made = std::make_unique<fathom_scene>();
  if (compiled.scene) {
    if (Error error = compiled.scene.objects(made->objects)) return error;
    made->scene = compiled.scene;
  }
  if (diagnostics != nullptr && !compiled.diagnostics.empty()) {
    *diagnostics = new fathom_diagnostics{std::move(compiled.diagnostics)};
  }
  if (compiled.scene) *scene = made.release();
  return compiled.error;
}

template <class T>
fathom::Points<T> to_points(const T* points, std::ptrdiff_t stride, std::size_t count) {
  return {points, points + 1, points + 2, count, stride};
}

// Fills results for points that are T, x after y after z.
template <class T>
int evaluate(const fathom_scene* scene, const T* points, std::ptrdiff_t stride, std::size_t count, T* distance,
             T* gradient, std::uint32_t* object, fathom_error* error) {
  return call(error, [&]() -> Error {
    if (Error problem = check_given({{"scene", scene}})) return problem;
    if (count > 0) {
      if (Error problem = check_given({{"points", points}})) return problem;
    }
    fathom::Values<T> out;
    if (distance != nullptr) out.distance = {distance, count};
    if (gradient != nullptr) out.gradient = {reinterpret_cast<fathom::Vec3<T>*>(gradient), count};
    if (object != nullptr) out.object = {object, count};
    return count == 0 ? Error{} : scene->scene.evaluate(to_points(points, stride, count), out);
  });
}

fathom::RenderOptions to_options(const fathom_render_options* options, std::stop_source& stop) {
  fathom::RenderOptions out;
  if (options == nullptr) return out;
  if (options->width != 0) out.width = options->width;
  if (options->height != 0) out.height = options->height;
  if (options->samples != 0) out.samples = options->samples;
  if (options->has_seed != 0) out.seed = options->seed;
  if (options->time_limit > 0) out.time_limit = options->time_limit;
  out.threads = options->threads;
  out.denoise = options->denoise != 0;
  out.stop = stop.get_token();
  if (options->progress != nullptr) {
    out.progress = [options, &stop](double fraction) {
      if (options->progress(fraction, options->user) != 0) stop.request_stop();
    };
  }
  return out;
}

fathom::MeshOptions to_options(const fathom_mesh_options* options) {
  fathom::MeshOptions out;
  if (options == nullptr) return out;
  if (options->tolerance != 0) out.tolerance = options->tolerance;
  if (options->resolution != 0) out.resolution = options->resolution;
  if (const double* box = options->box) out.box = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
  out.simplify = options->keep_triangles == 0;
  out.threads = options->threads;
  return out;
}

std::size_t pixels_of(const fathom_image* image) {
  return static_cast<std::size_t>(image->image.width()) * static_cast<std::size_t>(image->image.height());
}

void copy(fathom::Vec3d from, double to[3]) {
  to[0] = from.x;
  to[1] = from.y;
  to[2] = from.z;
}

}  // namespace

const char* fathom_version(void) { return fathom::version(); }
const char* fathom_instruction_set(void) { return fathom::instruction_set(); }

int fathom_compile(const char* text, size_t length, const fathom_compile_options* options, fathom_scene** scene,
                   fathom_diagnostics** diagnostics, fathom_error* error) {
  if (diagnostics != nullptr) *diagnostics = nullptr;
  if (scene != nullptr) *scene = nullptr;
  return call(error, [&]() -> Error {
    if (Error problem = check_given({{"text", text}, {"scene", scene}})) return problem;
    fathom::CompileOptions how;
    if (Error problem = to_options(options, how)) return problem;
    return hand_over(fathom::compile({text, length}, how), scene, diagnostics);
  });
}

int fathom_load(const char* path, const fathom_compile_options* options, fathom_scene** scene,
                fathom_diagnostics** diagnostics, fathom_error* error) {
  if (diagnostics != nullptr) *diagnostics = nullptr;
  if (scene != nullptr) *scene = nullptr;
  return call(error, [&]() -> Error {
    if (Error problem = check_given({{"path", path}, {"scene", scene}})) return problem;
    fathom::CompileOptions how;
    if (Error problem = to_options(options, how)) return problem;
    return hand_over(fathom::load(path, how), scene, diagnostics);
  });
}

void fathom_scene_free(fathom_scene* scene) { delete scene; }

size_t fathom_diagnostics_count(const fathom_diagnostics* diagnostics) {
  return diagnostics == nullptr ? 0 : diagnostics->all.size();
}

int fathom_diagnostics_get(const fathom_diagnostics* diagnostics, size_t index, fathom_diagnostic* out) {
  if (out == nullptr || index >= fathom_diagnostics_count(diagnostics)) return FATHOM_BAD_ARGUMENT;
  const fathom::Diagnostic& each = diagnostics->all[index];
  *out = {each.error, each.code.c_str(), each.message.c_str(), each.file.c_str(), each.label.c_str(),
          each.line,  each.column,       each.begin,           each.end,          each.help.size()};
  return FATHOM_OK;
}

const char* fathom_diagnostics_help(const fathom_diagnostics* diagnostics, size_t index, size_t help) {
  if (index >= fathom_diagnostics_count(diagnostics)) return nullptr;
  const std::vector<std::string>& all = diagnostics->all[index].help;
  return help < all.size() ? all[help].c_str() : nullptr;
}

void fathom_diagnostics_free(fathom_diagnostics* diagnostics) { delete diagnostics; }

void fathom_bounds(const fathom_scene* scene, double lo[3], double hi[3]) {
  const fathom::Box box = scene == nullptr ? fathom::Scene().bounds() : scene->scene.bounds();
  if (lo != nullptr) copy(box.lo, lo);
  if (hi != nullptr) copy(box.hi, hi);
}

double fathom_lipschitz(const fathom_scene* scene, int* certified) {
  if (certified != nullptr) *certified = scene != nullptr && scene->scene.certified();
  return scene == nullptr ? 0 : scene->scene.lipschitz();
}

size_t fathom_object_count(const fathom_scene* scene) { return scene == nullptr ? 0 : scene->objects.size(); }

const char* fathom_object_name(const fathom_scene* scene, size_t object) {
  return object < fathom_object_count(scene) ? scene->objects[object].c_str() : nullptr;
}

int fathom_distance_f32(const fathom_scene* scene, const float* points, ptrdiff_t stride, size_t count,
                        float* distance, fathom_error* error) {
  if (distance == nullptr && count > 0) return report(check_given({{"distance", distance}}), error);
  return evaluate<float>(scene, points, stride, count, distance, nullptr, nullptr, error);
}
int fathom_distance_f64(const fathom_scene* scene, const double* points, ptrdiff_t stride, size_t count,
                        double* distance, fathom_error* error) {
  if (distance == nullptr && count > 0) return report(check_given({{"distance", distance}}), error);
  return evaluate<double>(scene, points, stride, count, distance, nullptr, nullptr, error);
}
int fathom_evaluate_f32(const fathom_scene* scene, const float* points, ptrdiff_t stride, size_t count,
                        float* distance, float* gradient, uint32_t* object, fathom_error* error) {
  return evaluate<float>(scene, points, stride, count, distance, gradient, object, error);
}
int fathom_evaluate_f64(const fathom_scene* scene, const double* points, ptrdiff_t stride, size_t count,
                        double* distance, double* gradient, uint32_t* object, fathom_error* error) {
  return evaluate<double>(scene, points, stride, count, distance, gradient, object, error);
}

int fathom_range(const fathom_scene* scene, const double lo[3], const double hi[3], double range[2],
                 fathom_error* error) {
  return call(error, [&]() -> Error {
    if (Error problem = check_given({{"scene", scene}, {"lo", lo}, {"hi", hi}, {"range", range}})) return problem;
    const fathom::Box box{{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
    fathom::Interval interval{0, 0};
    Error problem = scene->scene.range({&box, 1}, {&interval, 1});
    range[0] = interval.lo;
    range[1] = interval.hi;
    return problem;
  });
}

int fathom_march(const fathom_scene* scene, const double* origins, const double* directions, size_t count,
                 fathom_hit* hits, fathom_error* error) {
  return call(error, [&]() -> Error {
    if (Error problem = check_given({{"scene", scene}})) return problem;
    if (count > 0) {
      if (Error problem = check_given({{"origins", origins}, {"directions", directions}, {"hits", hits}}))
        return problem;
    }
    std::vector<fathom::Ray> rays(count);
    std::vector<fathom::Hit> results(count);
    for (std::size_t i = 0; i < count; ++i) {
      rays[i].origin = {origins[3 * i], origins[3 * i + 1], origins[3 * i + 2]};
      rays[i].direction = {directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]};
    }
    if (Error problem = scene->scene.march(rays, results)) return problem;
    for (std::size_t i = 0; i < count; ++i) {
      const fathom::Hit& from = results[i];
      hits[i] = {from.hit, from.inside, from.t, {}, {}, from.object};
      copy(from.position, hits[i].position);
      copy(from.normal, hits[i].normal);
    }
    return {};
  });
}

int fathom_render(const fathom_scene* scene, const fathom_render_options* options, fathom_image** image,
                  fathom_error* error) {
  if (image != nullptr) *image = nullptr;
  return call(error, [&]() -> Error {
    if (Error problem = check_given({{"scene", scene}, {"image", image}})) return problem;
    std::stop_source stop;
    fathom::Rendered rendered = scene->scene.render(to_options(options, stop));
    if (!rendered.error) *image = new fathom_image{std::move(rendered.image)};
    return rendered.error;
  });
}

int fathom_image_width(const fathom_image* image) { return image == nullptr ? 0 : image->image.width(); }
int fathom_image_height(const fathom_image* image) { return image == nullptr ? 0 : image->image.height(); }
int fathom_image_complete(const fathom_image* image) { return image != nullptr && image->image.complete(); }

int fathom_image_read(const fathom_image* image, fathom_layer layer, float* out, fathom_error* error) {
  if (Error problem = check_given({{"image", image}, {"out", out}})) return report(problem, error);
  if (layer < FATHOM_RADIANCE || layer > FATHOM_POSITION) {
    return report(fathom::library::bad_argument("there is no such layer"), error);
  }
  return report(image->image.read(static_cast<fathom::Layer>(layer), {out, 3 * pixels_of(image)}), error);
}

int fathom_image_display(const fathom_image* image, uint8_t* out, fathom_error* error) {
  if (Error problem = check_given({{"image", image}, {"out", out}})) return report(problem, error);
  return report(image->image.read_display({out, 3 * pixels_of(image)}), error);
}

int fathom_image_depth(const fathom_image* image, float* out, fathom_error* error) {
  if (Error problem = check_given({{"image", image}, {"out", out}})) return report(problem, error);
  return report(image->image.read_depth({out, pixels_of(image)}), error);
}

int fathom_image_objects(const fathom_image* image, uint32_t* out, fathom_error* error) {
  if (Error problem = check_given({{"image", image}, {"out", out}})) return report(problem, error);
  return report(image->image.read_objects({out, pixels_of(image)}), error);
}

int fathom_image_write(const fathom_image* image, const char* path, fathom_error* error) {
  if (Error problem = check_given({{"image", image}, {"path", path}})) return report(problem, error);
  return call(error, [&] { return image->image.write(path); });
}

void fathom_image_free(fathom_image* image) { delete image; }

int fathom_make_mesh(const fathom_scene* scene, const fathom_mesh_options* options, const fathom_mesh** mesh,
                     fathom_error* error) {
  if (mesh != nullptr) *mesh = nullptr;
  return call(error, [&]() -> Error {
    if (Error problem = check_given({{"scene", scene}, {"mesh", mesh}})) return problem;
    fathom::Meshed made = scene->scene.mesh(to_options(options));
    if (made.error) return made.error;
    auto owned = std::make_unique<OwnedMesh>();
    owned->mesh = std::move(made.mesh);
    const fathom::Mesh& all = owned->mesh;
    owned->view = {all.vertices.size(),
                   all.triangles.size(),
                   &all.vertices.data()->x,
                   all.triangles.data()->data(),
                   all.objects.data(),
                   all.bound,
                   all.proved};
    *mesh = &owned.release()->view;
    return {};
  });
}

void fathom_mesh_free(const fathom_mesh* mesh) { delete reinterpret_cast<const OwnedMesh*>(mesh); }
