// 3MF: a zip file with an XML model. libzip packs it.
#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <iterator>

#include "runtime/mesh/files/mesh_bytes.h"
#include "runtime/mesh/files/mesh_file.h"
#include "runtime/mesh/mesh_sets.h"

namespace fathom::runtime {
namespace {

constexpr std::string_view kContentTypes =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
    "</Types>\n";
constexpr std::string_view kRelations =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n";

// Returns a text as the value of an XML attribute. Control characters, which XML does not have, become blanks.
std::string attribute(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return out;
}

std::string hex_color(const MeshMaterial& material) {
  const auto color = shown_color_bytes(material);
  const auto alpha = static_cast<unsigned>(std::min(1.0, std::max(0.0, material.opacity)) * 255 + 0.5);
  return fmt::format("#{:02X}{:02X}{:02X}{:02X}", color[0], color[1], color[2], alpha);
}

// Resources are numbered: base materials, a group with one colour per material, a mesh per part, and all parts.
constexpr std::size_t kBaseMaterials = 1, kFirstColor = 2;

void write_materials(const MeshDocument& document, fmt::memory_buffer& text) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "<basematerials id=\"{}\">\n", kBaseMaterials);
  for (const MeshMaterial& material : document.materials) {
    fmt::format_to(out, "<base name=\"{}\" displaycolor=\"{}\"/>\n",
                   attribute(material.name.empty() ? "default" : material.name), hex_color(material));
  }
  fmt::format_to(out, "</basematerials>\n");
  for (std::size_t i = 0; i < document.materials.size(); ++i) {
    fmt::format_to(out, "<m:colorgroup id=\"{}\"><m:color color=\"{}\"/></m:colorgroup>\n", kFirstColor + i,
                   hex_color(document.materials[i]));
  }
}

// Returns the material of most triangles.
std::size_t main_material(const MeshDocument& document, const MeshPart& part) {
  std::vector<std::size_t> counts(document.materials.size());
  for (const std::uint32_t t : part.triangles) ++counts[document.material_of[document.mesh.triangles[t].surface]];
  return static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

// The triangles name base materials. Slicers read only the object's property, and of that only a group's one colour.
void write_part(const MeshDocument& document, const MeshPart& part, std::size_t id, fmt::memory_buffer& text) {
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "<object id=\"{}\" type=\"model\" name=\"{}\" pid=\"{}\" pindex=\"0\"><mesh>\n<vertices>\n", id,
                 attribute(part.name), kFirstColor + main_material(document, part));
  const PartVertices vertices(document.mesh, part.triangles);
  for (const std::uint32_t each : vertices.used) {
    const glm::vec3 v(document.mesh.vertices[each]);
    fmt::format_to(out, "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", v.x, v.y, v.z);
  }
  fmt::format_to(out, "</vertices>\n<triangles>\n");
  for (const std::uint32_t t : part.triangles) {
    const Triangle& triangle = document.mesh.triangles[t];
    const auto& v = triangle.vertices;
    fmt::format_to(out, "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\" pid=\"{}\" p1=\"{}\"/>\n", vertices.number(v[0]),
                   vertices.number(v[1]), vertices.number(v[2]), kBaseMaterials,
                   document.material_of[triangle.surface]);
  }
  fmt::format_to(out, "</triangles>\n</mesh></object>\n");
}

std::string model_xml(const MeshDocument& document) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  const std::string_view unit = document.unit ? document.unit->name_in_3mf : kLengthUnits.front().name_in_3mf;
  fmt::format_to(out,
                 "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{}\" xml:lang=\"en-US\" "
                 "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
                 "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n"
                 "<metadata name=\"Application\">fathom</metadata>\n<resources>\n",
                 unit);
  write_materials(document, text);
  const std::size_t first = kFirstColor + document.materials.size(), count = document.parts.size();
  for (std::size_t i = 0; i < count; ++i) write_part(document, document.parts[i], first + i, text);
  if (count > 1) {
    fmt::format_to(out, "<object id=\"{}\" type=\"model\" name=\"{}\"><components>\n", first + count,
                   attribute(document.name));
    for (std::size_t i = 0; i < count; ++i) fmt::format_to(out, "<component objectid=\"{}\"/>\n", first + i);
    fmt::format_to(out, "</components></object>\n");
  }
  fmt::format_to(out, "</resources>\n<build><item objectid=\"{}\"/></build>\n</model>\n",
                 count > 1 ? first + count : first);
  return fmt::to_string(text);
}

// Adds a file to the archive, with the oldest date that zip knows: equal meshes are equal files.
bool add_file(zip_t* archive, const char* name, std::string_view text) {
  zip_source_t* source = zip_source_buffer(archive, text.data(), text.size(), 0);
  if (source == nullptr) return false;
  const zip_int64_t index = zip_file_add(archive, name, source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(source);
    return false;
  }
  constexpr zip_uint16_t kFirstDay = 1 << 5 | 1;
  return zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, kFirstDay, 0) == 0;
}

std::optional<std::vector<std::uint8_t>> read_all(zip_source_t* source) {
  zip_stat_t stat;
  if (zip_source_stat(source, &stat) != 0 || zip_source_open(source) != 0) return std::nullopt;
  std::vector<std::uint8_t> bytes(stat.size);
  const zip_int64_t read = zip_source_read(source, bytes.data(), bytes.size());
  zip_source_close(source);
  if (read != static_cast<zip_int64_t>(bytes.size())) return std::nullopt;
  return bytes;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> encode_3mf(const MeshDocument& document) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &error);
  if (target == nullptr) return std::nullopt;
  zip_source_keep(target);  // zip_close() gives one reference back
  zip_t* archive = zip_open_from_source(target, ZIP_TRUNCATE, &error);
  std::optional<std::vector<std::uint8_t>> bytes;
  if (archive != nullptr) {
    const std::string model = model_xml(document);
    const bool added = add_file(archive, "[Content_Types].xml", kContentTypes) &&
                       add_file(archive, "_rels/.rels", kRelations) && add_file(archive, "3D/3dmodel.model", model);
    if (added && zip_close(archive) == 0) {
      bytes = read_all(target);
    } else {
      zip_discard(archive);
    }
  }
  zip_source_free(target);
  zip_error_fini(&error);
  return bytes;
}

}  // namespace fathom::runtime
