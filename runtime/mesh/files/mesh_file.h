// Mesh files: STL, PLY, OBJ with MTL, 3MF and GLB.
//
// Sources: the formats' specifications: Burns, "Automated fabrication", 1993 (binary STL); Turk, "The PLY polygon
// file format", 1994; Wavefront, "Object files", 1993; 3MF Consortium, "Core specification 1.3", 2021; Khronos,
// "glTF 2.0", 2021. Tested by: tests/runtime/mesh/files/mesh_file_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/mesh/files/mesh_materials.h"

namespace fathom::runtime {

enum class MeshFormat { Stl, Ply, Obj, ThreeMf, Glb };
struct MeshFormatInfo {
  MeshFormat format;
  std::string_view ending;
};
inline constexpr std::array kMeshFormats = {
    MeshFormatInfo{MeshFormat::Stl, "stl"}, MeshFormatInfo{MeshFormat::Ply, "ply"},
    MeshFormatInfo{MeshFormat::Obj, "obj"}, MeshFormatInfo{MeshFormat::ThreeMf, "3mf"},
    MeshFormatInfo{MeshFormat::Glb, "glb"},
};
// Returns the format that a file's name says, or null.
const MeshFormatInfo* mesh_format_of(std::string_view path);

// Units of length. 3MF names its unit; the coordinates of glTF are metres.
struct LengthUnit {
  std::string_view name, name_in_3mf;
  double metres;
};
inline constexpr std::array kLengthUnits = {
    LengthUnit{"mm", "millimeter", 0.001},
    LengthUnit{"cm", "centimeter", 0.01},
    LengthUnit{"m", "meter", 1},
    LengthUnit{"in", "inch", 0.0254},
};

// Closed parts of a mesh, which share no vertex, with the names of their objects.
struct MeshPart {
  std::string name;
  std::vector<std::uint32_t> triangles;  // ascending
};
// Returns the parts, in the order of their first triangles. Triangles that share a vertex or an object's name are of
// one part, so a hollow is of the part around it. A part without names is called `name`.
std::vector<MeshPart> mesh_parts(const TriangleMesh& mesh, const std::vector<std::string>& surface_names,
                                 const std::string& name);

// A mesh with everything that files say of it.
struct MeshDocument {
  TriangleMesh mesh;  // in the coordinates of the file, scene units
  std::vector<MeshMaterial> materials;
  std::vector<std::uint32_t> material_of;  // [surface]
  std::vector<MeshPart> parts;
  std::string name;                  // of the whole
  const LengthUnit* unit = nullptr;  // of a scene unit; null: not given

  const MeshMaterial& material(const Triangle& triangle) const { return materials[material_of[triangle.surface]]; }
};

// Each function returns the bytes of a file. In GLB coordinates are in metres, one per scene unit without a unit. 3MF
// takes scene units without a unit as millimetres.
std::vector<std::uint8_t> encode_stl(const MeshDocument& document);
// Colours stand at vertices, for Blender, and at faces.
std::vector<std::uint8_t> encode_ply(const MeshDocument& document);
std::vector<std::uint8_t> encode_obj(const MeshDocument& document, std::string_view material_file);
// Returns the name of the file of materials beside an OBJ file: without blanks, at which `mtllib` ends a name.
std::string material_file_of(const std::string& path);
std::vector<std::uint8_t> encode_mtl(const MeshDocument& document);
std::vector<std::uint8_t> encode_glb(const MeshDocument& document);
// Returns nothing if the library that packs the file fails.
std::optional<std::vector<std::uint8_t>> encode_3mf(const MeshDocument& document);

}  // namespace fathom::runtime
