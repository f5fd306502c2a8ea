#include "runtime/mesh/files/mesh_file.h"

#include <zip.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/catch.h"
#include "tests/support/compiled.h"

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
  document.parts = mesh_parts(document.mesh, {}, document.name);
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
  CHECK(bytes[face + 13] == 255);  // emission counts, too
}

TEST_CASE("mesh files: OBJ numbers from one and names its materials", "[mesh]") {
  const auto bytes = encode_obj(tetrahedron(), "part.mtl");
  const std::string text(bytes.begin(), bytes.end());
  CHECK(text ==
        "mtllib part.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no a_part\nusemtl red_<1>\nf 1 3 2\nusemtl glow\n"
        "f 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const auto mtl = encode_mtl(tetrahedron());
  CHECK_THAT(std::string(mtl.begin(), mtl.end()), Contains("newmtl red_<1>\nKd 1 0 0\n") && Contains("Ke 4 2 0"));
}

// Materials whose names became one showed their objects in one colour, and a `\\` joined a line to the next.
TEST_CASE("mesh files: every material has a word of its own in MTL", "[mesh]") {
  MeshDocument document = tetrahedron();
  document.materials.resize(9);
  const char* names[] = {"two words", "two_words", "two#words", "", "default", "a\\", "a_", "a\tb", "two_words_2"};
  for (std::size_t i = 0; i < 9; ++i) document.materials[i].name = names[i];
  document.material_of = {0, 1};
  const auto bytes = encode_mtl(document);
  std::istringstream mtl(std::string(bytes.begin(), bytes.end()));
  std::vector<std::string> words;
  for (std::string word; mtl >> word;) {
    if (word == "newmtl") mtl >> words.emplace_back();
  }
  CHECK(words == std::vector<std::string>{"two_words_3", "two_words", "two_words_4", "default_2", "default", "a__2",
                                          "a_", "a_b", "two_words_2"});
  const auto obj = encode_obj(document, "part.mtl");
  CHECK_THAT(std::string(obj.begin(), obj.end()), Contains("usemtl two_words_3\n") && Contains("usemtl two_words\n"));
}

// In the format, blanks separate the names of several files of materials.
TEST_CASE("mesh files: the file of materials has a name of one word", "[mesh]") {
  CHECK(material_file_of("my files/out a.obj") == "my files/out_a.mtl");
  CHECK(material_file_of("a\tb.obj") == "a_b.mtl");
  CHECK(material_file_of("a\\.obj") == "a_.mtl");
  CHECK(material_file_of("a#1.OBJ") == "a_1.mtl");
  CHECK(material_file_of("/x/part.v2.obj") == "/x/part.v2.mtl");
}

TEST_CASE("mesh files: parts share no vertex and no object", "[mesh]") {
  TriangleMesh mesh;
  mesh.vertices.resize(15);
  // Two triangles of `case` that share no vertex, one of `case` and `lid` each at one vertex, and one of `pin`.
  mesh.triangles = {{{0, 1, 2}, 0}, {{3, 4, 5}, 0}, {{6, 7, 8}, 2}, {{5, 9, 10}, 1}, {{11, 12, 13}, 3}};
  const auto parts = mesh_parts(mesh, {"case", "lid", "pin", ""}, "file");
  REQUIRE(parts.size() == 3);
  CHECK(parts[0].name == "case, lid");
  CHECK(parts[0].triangles == std::vector<std::uint32_t>{0, 1, 3});
  CHECK(parts[1].name == "pin");
  CHECK(parts[2].name == "file");
}

// A lamp reflected all light in other programs, because its emission counted as albedo.
TEST_CASE("mesh files: emitters keep their albedo, and glass is clear", "[mesh]") {
  const auto scene = test::compiled(R"({"version": 1, "materials": {
      "lamp": {"type": "emissive", "emission": 3, "color": [0.1, 0.2, 0.3]},
      "dark": {"type": "emissive", "emission": [0.5, 0, 0]},
      "glow": {"type": "principled", "base_color": 0.25, "emission_color": 2, "emission_luminance": 1},
      "glass": {"type": "transparent", "color": 0.9, "ior": 1.45},
      "green": {"type": "principled", "transmission_weight": 1, "transmission_color": [0.5, 1, 0.5],
                "transmission_depth": 2, "specular_ior": 1.6, "specular_roughness": 0}},
    "objects": [{"type": "sphere", "radius": 1, "material": "lamp"}, {"type": "sphere", "radius": 2, "material": "dark"},
                {"type": "sphere", "radius": 3, "material": "glow"}, {"type": "sphere", "radius": 4, "material": "glass"},
                {"type": "sphere", "radius": 5, "material": "green"}]})");
  MeshDocument document = tetrahedron();
  document.material_of.clear();
  document.materials = mesh_materials(scene, document.mesh, document.material_of);
  const auto bytes = encode_glb(document);
  const auto json = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + read_at<std::uint32_t>(bytes, 12));
  const auto named = [&](const std::string& name) {
    for (const auto& material : json["materials"]) {
      if (material["name"] == name) return material;
    }
    return nlohmann::json();
  };
  const auto color = [&](const std::string& name, std::size_t i) {
    return named(name)["pbrMetallicRoughness"]["baseColorFactor"][i].get<double>();
  };
  CHECK(color("lamp", 0) == Approx(0.1));
  CHECK(color("lamp", 2) == Approx(0.3));
  CHECK(named("lamp")["emissiveFactor"][0] == 1);
  CHECK(named("lamp")["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] == 3);
  CHECK(color("dark", 0) == 0);
  CHECK(color("glow", 1) == Approx(0.25));
  CHECK(color("glass", 1) == Approx(0.9));
  const auto glass = named("glass")["extensions"], green = named("green")["extensions"];
  CHECK(glass["KHR_materials_transmission"]["transmissionFactor"] == 1);
  CHECK(glass["KHR_materials_ior"]["ior"].get<double>() == Approx(1.45));
  CHECK(glass["KHR_materials_volume"]["thicknessFactor"].get<double>() > 0);
  CHECK_FALSE(glass["KHR_materials_volume"].contains("attenuationDistance"));
  CHECK(color("green", 0) == Approx(1));
  // Half of the red is left after two units, in inches.
  const double distance = green["KHR_materials_volume"]["attenuationDistance"].get<double>() / 0.0254;
  const double red = green["KHR_materials_volume"]["attenuationColor"][0].get<double>();
  CHECK(-std::log(red) / distance == Approx(std::log(2.0) / 2));
  CHECK(green["KHR_materials_volume"]["attenuationColor"][1].get<double>() == Approx(1));
  CHECK(json["extensionsUsed"].size() == 4);
  const auto mtl = encode_mtl(document);
  CHECK_THAT(std::string(mtl.begin(), mtl.end()),
             Contains("newmtl dark\nKd 0 0 0\nKe 0.5 0 0\n") && Contains("Ni 1.45"));
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
  // Slicers read the object's property and take a group's last colour; others read the triangles' base materials.
  CHECK_THAT(text, Contains("<m:colorgroup id=\"3\"><m:color color=\"#FFFFE7FF\"/></m:colorgroup>") &&
                       Contains("<object id=\"4\" type=\"model\" name=\"a part\" pid=\"3\" pindex=\"0\">"));
  CHECK_THAT(text, Contains("unit=\"inch\"") && Contains("name=\"red &lt;1&gt;\" displaycolor=\"#FF0000FF\""));
  CHECK_THAT(text, Contains("<vertex x=\"0\" y=\"1\" z=\"0\"/>") &&
                       Contains("<triangle v1=\"1\" v2=\"2\" v3=\"3\" pid=\"1\" p1=\"1\"/>"));
}

}  // namespace fathom::mesh_file_test
