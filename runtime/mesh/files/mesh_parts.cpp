// Parts of a mesh with the names of their objects.
#include <algorithm>
#include <map>

#include "runtime/mesh/files/mesh_file.h"
#include "runtime/mesh/mesh_sets.h"

namespace fathom::runtime {
namespace {

// Names that a part's name lists; the others are counted.
constexpr std::size_t kMostNames = 4;

std::string joined(const std::vector<std::string>& names, const std::string& if_none) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) text += (text.empty() ? "" : ", ") + names[i];
  if (names.size() > kMostNames) text += " and " + std::to_string(names.size() - kMostNames) + " more";
  return text.empty() ? if_none : text;
}

}  // namespace

std::vector<MeshPart> mesh_parts(const TriangleMesh& mesh, const std::vector<std::string>& surface_names,
                                 const std::string& name) {
  DisjointSets sets = connected_vertices(mesh);
  const auto name_of = [&](const Triangle& triangle) {
    return triangle.surface < surface_names.size() ? surface_names[triangle.surface] : std::string();
  };
  std::map<std::string, std::uint32_t> first_of;  // [name] a vertex
  for (const Triangle& triangle : mesh.triangles) {
    const auto [at, is_new] = first_of.try_emplace(name_of(triangle), triangle.vertices[0]);
    if (!is_new) sets.join(at->second, triangle.vertices[0]);
  }
  std::map<std::uint32_t, std::size_t> part_of;  // [root]
  std::vector<MeshPart> parts;
  std::vector<std::vector<std::string>> names;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const auto [at, is_new] = part_of.try_emplace(sets.root(triangle.vertices[0]), parts.size());
    if (is_new) parts.emplace_back(), names.emplace_back();
    parts[at->second].triangles.push_back(t);
    const std::string text = name_of(triangle);
    std::vector<std::string>& known = names[at->second];
    if (!text.empty() && std::ranges::find(known, text) == known.end()) known.push_back(text);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].name = joined(names[i], name);
  return parts;
}

}  // namespace fathom::runtime
