// STL, PLY and OBJ.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>

#include "compiler/scene/srgb.h"
#include "runtime/mesh/files/mesh_bytes.h"
#include "runtime/mesh/files/mesh_file.h"

namespace fathom::runtime {
namespace {

// Returns for each vertex the least material of its triangles.
std::vector<std::uint32_t> vertex_materials(const MeshDocument& document) {
  std::vector<std::uint32_t> of(document.mesh.vertices.size(), 0xffffffff);
  for (const Triangle& triangle : document.mesh.triangles) {
    for (const std::uint32_t v : triangle.vertices) of[v] = std::min(of[v], document.material_of[triangle.surface]);
  }
  return of;
}

// Returns a word per material, all different. Names that are words keep them.
std::vector<std::string> material_words(const MeshDocument& document) {
  std::set<std::string> taken;
  for (const MeshMaterial& material : document.materials) {
    if (word_of(material.name, "default") == material.name) taken.insert(material.name);
  }
  std::vector<std::string> words;
  std::set<std::string> used;
  for (const MeshMaterial& material : document.materials) {
    const std::string word = word_of(material.name, "default");
    std::string unique = word;
    const bool kept = word == material.name && used.insert(word).second;
    for (int number = 2; !kept && !taken.insert(unique).second; ++number) unique = fmt::format("{}_{}", word, number);
    words.push_back(unique);
  }
  return words;
}

std::string mtl_color(glm::dvec3 color) { return fmt::format("{:.6g} {:.6g} {:.6g}", color.x, color.y, color.z); }

}  // namespace

const MeshFormatInfo* mesh_format_of(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos || dot == 0 || path[dot - 1] == '/') return nullptr;
  std::string ending(path.substr(dot + 1));
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const MeshFormatInfo& info : kMeshFormats) {
    if (info.ending == ending) return &info;
  }
  return nullptr;
}

std::string material_file_of(const std::string& path) {
  std::filesystem::path file(path);
  return file.replace_filename(word_of(file.stem().string(), "mesh") + ".mtl").string();
}

std::vector<std::uint8_t> encode_stl(const MeshDocument& document) {
  constexpr std::size_t kHeader = 80;
  MeshBytes bytes;
  // A header that begins with `solid` would be taken for a text.
  std::string header = "fathom: " + word_of(document.name, "mesh");
  header.resize(kHeader, ' ');
  bytes.text(header);
  bytes.u32(static_cast<std::uint32_t>(document.mesh.triangles.size()));
  for (const Triangle& triangle : document.mesh.triangles) {
    const auto corners = document.mesh.corners(triangle);
    const glm::dvec3 area = area_normal(corners);
    const double length = glm::length(area);
    for (int i = 0; i < 3; ++i) bytes.f32(length > 0 ? area[i] / length : 0);
    for (const glm::dvec3& corner : corners) {
      for (int i = 0; i < 3; ++i) bytes.f32(corner[i]);
    }
    bytes.u16(0);
  }
  return bytes.take();
}

std::vector<std::uint8_t> encode_ply(const MeshDocument& document) {
  MeshBytes bytes;
  constexpr std::string_view kColor = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  bytes.text(fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\n{}element face {}\nproperty list uchar int vertex_indices\n{}end_header\n",
      word_of(document.name, "mesh"), document.mesh.vertices.size(), kColor, document.mesh.triangles.size(), kColor));
  std::vector<std::array<std::uint8_t, 3>> colors;
  for (const MeshMaterial& material : document.materials) colors.push_back(shown_color_bytes(material));
  const std::vector<std::uint32_t> materials = vertex_materials(document);
  for (std::size_t v = 0; v < document.mesh.vertices.size(); ++v) {
    for (int i = 0; i < 3; ++i) bytes.f32(document.mesh.vertices[v][i]);
    for (const std::uint8_t part : colors[materials[v]]) bytes.byte(part);
  }
  for (const Triangle& triangle : document.mesh.triangles) {
    bytes.byte(3);
    for (const std::uint32_t v : triangle.vertices) bytes.u32(v);
    for (const std::uint8_t part : colors[document.material_of[triangle.surface]]) bytes.byte(part);
  }
  return bytes.take();
}

std::vector<std::uint8_t> encode_obj(const MeshDocument& document, std::string_view material_file) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "mtllib {}\n", material_file);
  const std::vector<std::string> words = material_words(document);
  for (const glm::dvec3& v : document.mesh.vertices) {
    fmt::format_to(out, "v {} {} {}\n", static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
  }
  for (const MeshPart& part : document.parts) {
    fmt::format_to(out, "o {}\n", word_of(part.name, "mesh"));
    for (std::uint32_t material = 0; material < document.materials.size(); ++material) {
      bool named = false;
      for (const std::uint32_t t : part.triangles) {
        const Triangle& triangle = document.mesh.triangles[t];
        if (document.material_of[triangle.surface] != material) continue;
        if (!named) fmt::format_to(out, "usemtl {}\n", words[material]);
        named = true;
        const auto& v = triangle.vertices;
        fmt::format_to(out, "f {} {} {}\n", v[0] + 1, v[1] + 1, v[2] + 1);
      }
    }
  }
  return to_bytes({text.data(), text.size()});
}

std::vector<std::uint8_t> encode_mtl(const MeshDocument& document) {
  std::string text;
  const std::vector<std::string> words = material_words(document);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const MeshMaterial& m = document.materials[i];
    // The format does not say whether Kd is linear. The sRGB signal suits readers that show Kd as it is.
    const auto bytes = color_bytes(m.color);
    const glm::dvec3 signal = glm::dvec3(bytes[0], bytes[1], bytes[2]) / 255.0;
    text += fmt::format("newmtl {}\nKd {}\nKe {}\nd {:.6g}\nPr {:.6g}\nPm {:.6g}\n", words[i], mtl_color(signal),
                        mtl_color(m.emission), m.opacity, m.roughness, m.metalness);
    if (m.transmission > 0) {
      text += fmt::format("Tf {}\nNi {:.6g}\n", mtl_color(m.transmission * m.color), m.ior);
    }
  }
  return to_bytes(text);
}

}  // namespace fathom::runtime
