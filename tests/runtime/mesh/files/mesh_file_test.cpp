#include "runtime/mesh/files/mesh_file.h"
#include "tests/support/catch.h"

#include <zip.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

namespace fathom::mesh_file_test {

namespace {

using namespace fathom::runtime;
using Catch::Contains;

// A tetrahedron of two materials, in inches.
MeshDocument tetrahedron() {
  MeshDocument document;
  document.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  document.mesh.triangles = {{{0, 2, 1}, 0}, {{0, 1, 3}, 1}, {{0, 3, 2}, 1}, {{1, 2, 3}, 1}};
  document.materials.resize(2);
  document.materials[0].name = "red <1>";
  document.materials[0].color = {1, 0, 0};
  document.materials[1].name = "glow";
  document.materials[1].emission = {4, 2, 0};
  document.materials[1].metalness = 1;
  document.material_of = {0, 1};
  document.name = "a part";
  document.unit = &kLengthUnits[3];
  return document;
}

template <class T>
T read_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

TEST_CASE("mesh files: names say formats", "[mesh]") {
  CHECK(mesh_format_of("a.stl")->format == MeshFormat::Stl);
  CHECK(mesh_format_of("b/c.3MF")->format == MeshFormat::ThreeMf);
  CHECK(mesh_format_of("a.png") == nullptr);
  CHECK(mesh_format_of("dir/.obj") == nullptr);
  CHECK(mesh_format_of("stl") == nullptr);
}

TEST_CASE("mesh files: STL holds normals and corners", "[mesh]") {
  const auto bytes = encode_stl(tetrahedron());
  REQUIRE(bytes.size() == 84 + 4 * 50);
  CHECK(std::memcmp(bytes.data(), "solid", 5) != 0);
  CHECK(read_at<std::uint32_t>(bytes, 80) == 4);
  CHECK(read_at<float>(bytes, 84 + 8) == -1);            // the first normal is -z
  CHECK(read_at<float>(bytes, 84 + 50 + 12 + 12) == 1);  // the second corner of the second triangle
}

TEST_CASE("mesh files: PLY holds colours at vertices and faces", "[mesh]") {
  const auto bytes = encode_ply(tetrahedron());
  const std::string text(bytes.begin(), bytes.end());
  CHECK_THAT(text, Contains("element vertex 4\n") && Contains("element face 4\n"));
  const std::size_t data = text.find("end_header\n") + 11;
  REQUIRE(bytes.size() == data + 4 * 15 + 4 * 16);
  CHECK(bytes[data + 12] == 255);  // the first vertex is red
  CHECK(bytes[data + 13] == 0);
  const std::size_t face = data + 4 * 15 + 16;
  CHECK(bytes[face] == 3);
  CHECK(read_at<std::uint32_t>(bytes, face + 9) == 3);
  CHECK(bytes[face + 13] == 231);  // 0.8 as an sRGB signal
}

TEST_CASE("mesh files: OBJ numbers from one and names its materials", "[mesh]") {
  const auto bytes = encode_obj(tetrahedron(), "part.mtl");
  const std::string text(bytes.begin(), bytes.end());
  CHECK(text ==
        "mtllib part.mtl\no a_part\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red_<1>\nf 1 3 2\nusemtl glow\n"
        "f 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const auto mtl = encode_mtl(tetrahedron());
  CHECK_THAT(std::string(mtl.begin(), mtl.end()), Contains("newmtl red_<1>\nKd 1 0 0\n") && Contains("Ke 4 2 0"));
}

TEST_CASE("mesh files: GLB is in metres, with a primitive per material", "[mesh]") {
  const auto bytes = encode_glb(tetrahedron());
  REQUIRE(read_at<std::uint32_t>(bytes, 0) == 0x46546c67);
  REQUIRE(read_at<std::uint32_t>(bytes, 8) == bytes.size());
  const auto length = read_at<std::uint32_t>(bytes, 12);
  const auto json = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + length);
  CHECK(json["meshes"][0]["primitives"].size() == 2);
  CHECK(json["accessors"][0]["max"][0] == Approx(0.0254));
  CHECK(json["accessors"][2]["count"] == 9);
  CHECK(json["materials"][1]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] == 4);
  CHECK(json["materials"][1]["emissiveFactor"][1] == 0.5);
  const std::size_t binary = 20 + length + 8;
  CHECK(json["buffers"][0]["byteLength"] == bytes.size() - binary);
  CHECK(read_at<float>(bytes, binary + 12) == 0.0254f);
  CHECK(read_at<std::uint32_t>(bytes, binary + 48 + 4) == 2);
}

TEST_CASE("mesh files: 3MF is a zip with units and colours, the same at any time", "[mesh]") {
  const auto bytes = encode_3mf(tetrahedron());
  REQUIRE(bytes);
  CHECK(encode_3mf(tetrahedron()) == bytes);
  zip_error_t error;
  zip_t* archive =
      zip_open_from_source(zip_source_buffer_create(bytes->data(), bytes->size(), 0, &error), ZIP_RDONLY, &error);
  REQUIRE(archive != nullptr);
  CHECK(zip_name_locate(archive, "[Content_Types].xml", 0) == 0);
  zip_file_t* file = zip_fopen(archive, "3D/3dmodel.model", 0);
  REQUIRE(file != nullptr);
  std::string text(10000, ' ');
  text.resize(static_cast<std::size_t>(zip_fread(file, text.data(), text.size())));
  zip_fclose(file);
  zip_discard(archive);
  CHECK_THAT(text, Contains("unit=\"inch\"") && Contains("name=\"red &lt;1&gt;\" displaycolor=\"#FF0000FF\""));
  CHECK_THAT(text, Contains("<vertex x=\"0\" y=\"1\" z=\"0\"/>") &&
                       Contains("<triangle v1=\"1\" v2=\"2\" v3=\"3\" pid=\"1\" p1=\"1\"/>"));
}

}  // namespace fathom::mesh_file_test
