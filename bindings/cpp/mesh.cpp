#include <algorithm>
#include <fathom/fathom.hpp>

#include "bindings/cpp/guard.h"
#include "bindings/cpp/scene_data.h"
#include "runtime/base/machine.h"
#include "runtime/mesh/make_mesh.h"
#include "runtime/mesh/mesh_box.h"

namespace fathom {
namespace {

Error error_of(const runtime::MeshResult& result) {
  using End = runtime::MeshResult::End;
  switch (result.end) {
    case End::TooFine:
      return library::bad_argument("cells of this size are too small for single precision");
    case End::TooMany:
      return library::error_of(Error::Kind::OutOfMemory, "the mesh needs more memory than is allowed");
    case End::Empty:
      return {Error::Kind::BadScene, "no part of the scene is as thick as the cells: the mesh is empty"};
    case End::Done:
      break;
  }
  return {};
}

Error choose_box(const compiler::CompiledScene& scene, const MeshOptions& options, runtime::MeshBox& out) {
  std::optional<compiler::Box> wanted;
  if (options.box) {
    wanted =
        compiler::Box{library::to_glm(options.box->lo) - scene.origin, library::to_glm(options.box->hi) - scene.origin};
  }
  const auto chosen = runtime::mesh_box(scene, wanted);
  if (const auto* box = std::get_if<runtime::MeshBox>(&chosen)) {
    out = *box;
    return {};
  }
  if (std::get<runtime::NoMeshBox>(chosen) == runtime::NoMeshBox::Endless) {
    return library::bad_argument("the scene has no end, and a mesh has: the option `box` cuts the scene off");
  }
  return library::bad_argument(options.box ? "nothing of the scene is in the box" : "the scene is empty");
}

Error check(const MeshOptions& options) {
  if (options.tolerance && !(*options.tolerance > 0)) return library::bad_argument("the tolerance is not above 0");
  if (!options.tolerance && (options.resolution < runtime::kMinResolution || options.resolution > runtime::kMaxResolution)) {
    return library::bad_argument("the resolution is not from 4 to 262,144");
  }
  if (options.threads < 0) return library::bad_argument("the number of threads is below 0");
  if (options.box) return library::check_box("box", *options.box);
  return {};
}

// Copies the mesh, in the scene's coordinates.
void copy(const runtime::MeshResult& from, const compiler::CompiledScene& scene, Mesh& to) {
  for (const glm::dvec3& v : from.mesh.vertices) to.vertices.push_back(library::to_vec3(v + scene.origin));
  for (const runtime::Triangle& triangle : from.mesh.triangles) {
    to.triangles.push_back(triangle.vertices);
    to.objects.push_back(triangle.surface);
  }
  for (const runtime::LostPart& part : from.lost) {
    to.lost.push_back({library::to_vec3(part.place + scene.origin), part.thickness, part.surface, part.is_gap});
  }
  to.bound = from.bound;
  to.proved = scene.certified;
}

Error make(const Scene::Data& data, const MeshOptions& options, Mesh& out) {
  if (Error error = check(options)) return error;
  runtime::MeshBox chosen;
  if (Error error = choose_box(data.scene, options, chosen)) return error;
  runtime::MeshOptions request = runtime::mesh_options(chosen, options.tolerance, options.resolution);
  request.simplifies = options.simplify;
  request.memory = data.limits.memory;
  request.threads = options.threads > 0 ? options.threads : runtime::usable_processors();
  const runtime::MeshResult result = runtime::make_mesh(data.scene, chosen.box, request);
  if (Error error = error_of(result)) return error;
  copy(result, data.scene, out);
  return {};
}

}  // namespace

Meshed Scene::mesh(const MeshOptions& options) const noexcept {
  Meshed out;
  out.error = library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(library::kNoScene);
    return make(*data_, options, out.mesh);
  });
  return out;
}

}  // namespace fathom
