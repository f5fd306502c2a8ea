// GLB: glTF 2.0 in one file, a JSON chunk and a binary chunk. One primitive per material; all share the vertices.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/mesh/files/mesh_bytes.h"
#include "runtime/mesh/files/mesh_file.h"

namespace fathom::runtime {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kArrayBuffer = 34962, kElementArrayBuffer = 34963;  // targets of buffer views
constexpr std::uint32_t kFloat = 5126, kUnsignedInt = 5125;                 // types of components

Json three(glm::dvec3 v) { return Json::array({v.x, v.y, v.z}); }

Json material_json(const MeshMaterial& m) {
  const glm::dvec3 color = glm::clamp(m.color, 0.0, 1.0);
  Json json = {{"name", m.name},
               {"pbrMetallicRoughness",
                {{"baseColorFactor", {color.x, color.y, color.z, m.opacity}},
                 {"metallicFactor", m.metalness},
                 {"roughnessFactor", m.roughness}}}};
  if (m.opacity < 1) json["alphaMode"] = "BLEND";
  const double strongest = std::max({m.emission.x, m.emission.y, m.emission.z});
  if (!(strongest > 0)) return json;
  json["emissiveFactor"] = three(m.emission / std::max(1.0, strongest));
  if (strongest > 1) json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strongest;
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

void add_positions(const MeshDocument& document, GlbParts& parts) {
  const double metres = document.unit ? document.unit->metres : 1;
  glm::dvec3 lo(INFINITY), hi(-INFINITY);
  for (const glm::dvec3& v : document.mesh.vertices) {
    const glm::dvec3 place(glm::vec3(v * metres));
    for (int i = 0; i < 3; ++i) parts.binary.f32(place[i]);
    lo = glm::min(lo, place), hi = glm::max(hi, place);
  }
  parts.close_view(0, kArrayBuffer);
  parts.accessors.push_back({{"bufferView", 0},
                             {"componentType", kFloat},
                             {"count", document.mesh.vertices.size()},
                             {"type", "VEC3"},
                             {"min", three(lo)},
                             {"max", three(hi)}});
}

// Adds the triangles of a material. Returns false if it has none.
bool add_triangles(const MeshDocument& document, std::uint32_t material, GlbParts& parts) {
  const std::size_t start = parts.binary.size();
  for (const Triangle& triangle : document.mesh.triangles) {
    if (document.material_of[triangle.surface] != material) continue;
    for (const std::uint32_t v : triangle.vertices) parts.binary.u32(v);
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

}  // namespace

std::vector<std::uint8_t> encode_glb(const MeshDocument& document) {
  GlbParts parts;
  add_positions(document, parts);
  Json primitives = Json::array(), materials = Json::array();
  bool extended = false;
  for (std::uint32_t i = 0; i < document.materials.size(); ++i) {
    if (!add_triangles(document, i, parts)) continue;
    primitives.push_back(
        {{"attributes", {{"POSITION", 0}}}, {"indices", parts.accessors.size() - 1}, {"material", materials.size()}});
    materials.push_back(material_json(document.materials[i]));
    extended |= materials.back().contains("extensions");
  }
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "fathom"}}}};
  if (extended) json["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  json["scene"] = 0;
  json["scenes"] = {{{"nodes", {0}}}};
  json["nodes"] = {{{"mesh", 0}, {"name", document.name}}};
  json["meshes"] = {{{"name", document.name}, {"primitives", primitives}}};
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
