// GLB: glTF 2.0 in one file, a JSON chunk and a binary chunk. One mesh per part, one primitive per material.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "runtime/mesh/files/mesh_bytes.h"
#include "runtime/mesh/files/mesh_file.h"
#include "runtime/mesh/mesh_measures.h"
#include "runtime/mesh/mesh_sets.h"
#include "vm/number/real.h"

namespace fathom::runtime {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kArrayBuffer = 34962, kElementArrayBuffer = 34963;  // targets of buffer views
constexpr std::uint32_t kFloat = 5126, kUnsignedInt = 5125;                 // types of components

Json three(glm::dvec3 v) { return Json::array({v.x, v.y, v.z}); }

// Adds what KHR_materials_* say of light that gets through the surface. `depth`: a usual way through the body,
// metres.
void add_transmission(const MeshMaterial& m, double depth, double metres, Json& extensions) {
  extensions["KHR_materials_transmission"]["transmissionFactor"] = m.transmission;
  extensions["KHR_materials_ior"]["ior"] = m.ior;
  if (!m.has_interior) return;
  Json volume = {{"thicknessFactor", depth}};
  const double most = std::max({m.absorption.x, m.absorption.y, m.absorption.z});
  if (most > 0) {
    // The distance at which the most absorbed colour is down to 1/e.
    volume["attenuationDistance"] = metres / most;
    const glm::dvec3 share = m.absorption / most;
    volume["attenuationColor"] = {vm::real::exp(-share.x), vm::real::exp(-share.y), vm::real::exp(-share.z)};
  }
  extensions["KHR_materials_volume"] = volume;
}

Json material_json(const MeshMaterial& m, double depth, double metres) {
  const glm::dvec3 color = glm::clamp(m.color, 0.0, 1.0);
  Json json = {{"name", m.name},
               {"pbrMetallicRoughness",
                {{"baseColorFactor", {color.x, color.y, color.z, m.opacity}},
                 {"metallicFactor", m.metalness},
                 {"roughnessFactor", m.roughness}}}};
  if (m.opacity < 1) json["alphaMode"] = "BLEND";
  Json extensions = Json::object();
  if (m.transmission > 0) add_transmission(m, depth, metres, extensions);
  const double strongest = std::max({m.emission.x, m.emission.y, m.emission.z});
  if (strongest > 0) json["emissiveFactor"] = three(m.emission / std::max(1.0, strongest));
  if (strongest > 1) extensions["KHR_materials_emissive_strength"]["emissiveStrength"] = strongest;
  if (!extensions.empty()) json["extensions"] = extensions;
  return json;
}

// The parts of a file under construction.
struct GlbParts {
  MeshBytes binary;
  Json views = Json::array(), accessors = Json::array();

  void close_view(std::size_t start, std::uint32_t target) {
    views.push_back(
        {{"buffer", 0}, {"byteOffset", start}, {"byteLength", binary.size() - start}, {"target", target}});
  }
};

double metres_of(const MeshDocument& document) { return document.unit ? document.unit->metres : 1; }

void add_positions(const MeshDocument& document, const PartVertices& vertices, GlbParts& parts) {
  const std::size_t start = parts.binary.size();
  glm::dvec3 lo(INFINITY), hi(-INFINITY);
  for (const std::uint32_t v : vertices.used) {
    const glm::dvec3 place(glm::vec3(document.mesh.vertices[v] * metres_of(document)));
    for (int i = 0; i < 3; ++i) parts.binary.f32(place[i]);
    lo = glm::min(lo, place), hi = glm::max(hi, place);
  }
  parts.close_view(start, kArrayBuffer);
  parts.accessors.push_back({{"bufferView", parts.views.size() - 1},
                             {"componentType", kFloat},
                             {"count", vertices.used.size()},
                             {"type", "VEC3"},
                             {"min", three(lo)},
                             {"max", three(hi)}});
}

// Adds the triangles of a material. Returns false if the part has none.
bool add_triangles(const MeshDocument& document, const MeshPart& part, const PartVertices& vertices,
                   std::uint32_t material, GlbParts& parts) {
  const std::size_t start = parts.binary.size();
  for (const std::uint32_t t : part.triangles) {
    const Triangle& triangle = document.mesh.triangles[t];
    if (document.material_of[triangle.surface] != material) continue;
    for (const std::uint32_t v : triangle.vertices) parts.binary.u32(vertices.number(v));
  }
  const std::size_t count = (parts.binary.size() - start) / sizeof(std::uint32_t);
  if (count == 0) return false;
  parts.close_view(start, kElementArrayBuffer);
  parts.accessors.push_back({{"bufferView", parts.views.size() - 1},
                             {"componentType", kUnsignedInt},
                             {"count", count},
                             {"type", "SCALAR"}});
  return true;
}

// Adds a mesh with a primitive per material, and returns it.
Json add_part(const MeshDocument& document, const MeshPart& part, GlbParts& parts) {
  const PartVertices vertices(document.mesh, part.triangles);
  add_positions(document, vertices, parts);
  const std::size_t positions = parts.accessors.size() - 1;
  Json primitives = Json::array();
  for (std::uint32_t material = 0; material < document.materials.size(); ++material) {
    if (!add_triangles(document, part, vertices, material, parts)) continue;
    primitives.push_back(
        {{"attributes", {{"POSITION", positions}}}, {"indices", parts.accessors.size() - 1}, {"material", material}});
  }
  return {{"name", part.name}, {"primitives", primitives}};
}

// The mean length of a chord of a body: four times its volume over its area (Cauchy, 1850).
double mean_chord(const TriangleMesh& mesh) {
  const MeshMeasures measures = measure(mesh);
  return measures.area > 0 ? 4 * std::abs(measures.volume) / measures.area : 0;
}

}  // namespace

std::vector<std::uint8_t> encode_glb(const MeshDocument& document) {
  GlbParts parts;
  Json meshes = Json::array(), nodes = Json::array(), roots = Json::array(), materials = Json::array();
  for (const MeshPart& part : document.parts) {
    roots.push_back(nodes.size());
    nodes.push_back({{"mesh", meshes.size()}, {"name", part.name}});
    meshes.push_back(add_part(document, part, parts));
  }
  std::set<std::string> extensions;
  const double metres = metres_of(document), depth = metres * mean_chord(document.mesh);
  for (const MeshMaterial& material : document.materials) {
    materials.push_back(material_json(material, depth, metres));
    if (!materials.back().contains("extensions")) continue;
    for (const auto& [name, values] : materials.back()["extensions"].items()) extensions.insert(name);
  }
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "fathom"}}}};
  if (!extensions.empty()) json["extensionsUsed"] = extensions;
  json["scene"] = 0;
  json["scenes"] = {{{"name", document.name}, {"nodes", roots}}};
  json["nodes"] = nodes;
  json["meshes"] = meshes;
  json["materials"] = materials;
  json["accessors"] = parts.accessors;
  json["bufferViews"] = parts.views;
  json["buffers"] = {{{"byteLength", parts.binary.size()}}};
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  while (text.size() % 4 != 0) text += ' ';

  constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;
  const std::vector<std::uint8_t> binary = parts.binary.take();
  MeshBytes bytes;
  bytes.u32(kMagic), bytes.u32(2);
  bytes.u32(static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size()));
  bytes.u32(static_cast<std::uint32_t>(text.size())), bytes.u32(kJson), bytes.text(text);
  bytes.u32(static_cast<std::uint32_t>(binary.size())), bytes.u32(kBinary);
  bytes.text({reinterpret_cast<const char*>(binary.data()), binary.size()});
  return bytes.take();
}

}  // namespace fathom::runtime
