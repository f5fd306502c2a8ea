// Elaboration from the scene's syntax to the graph: names, materials, transforms, defaults. Messages:
// tests/golden/diagnostics.
#include "compiler/frontend/elaborate/elaborate.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>

#include "compiler/frontend/elaborate/placement.h"
#include "compiler/frontend/records/records.h"
#include "compiler/frontend/syntax/json.h"
#include "compiler/shapes/node_table.h"
#include "tests/compiler/frontend/elaborate/elaborated.h"
#include "tests/support/catch.h"
#include "tests/support/scaled_cases.h"

namespace fathom::elaborate_test {

namespace {

using namespace fathom::compiler;
using namespace fathom::test;

const std::string kRedBlue = R"(, "materials": {"red": {"type": "diffuse"}, "blue": {"type": "diffuse"}})";

TEST_CASE("one object is the root, several are a union", "[frontend][elaborate]") {
  CHECK(listing(of_objects(R"({"type": "sphere", "radius": 2})")) ==
        "%0 = sphere radius=2\n%1 = paint surface=0 %0\n");
  CHECK(listing(of_objects(R"({"type": "sphere", "radius": 2}, {"type": "plane", "normal": [0, 1, 0]})")) ==
        "%0 = sphere radius=2\n"
        "%1 = paint surface=0 %0\n"
        "%2 = plane normal=[0,1,0] offset=0\n"
        "%3 = paint surface=1 %2\n"
        "%4 = union %1 %3\n");
}

TEST_CASE("defaults are those of the documentation", "[frontend][elaborate]") {
  const ElaboratedScene e =
      of_objects(R"({"type": "sphere", "radius": 1})", R"(, "camera": {}, "film": {}, "render": {})");
  CHECK(e.camera.projection == Camera::Projection::Perspective);
  CHECK(e.camera.position == glm::dvec3(0, 0, 5));
  CHECK(e.camera.target == glm::dvec3(0));
  CHECK(e.camera.up == glm::dvec3(0, 1, 0));
  CHECK(e.camera.fov == Camera().fov);
  CHECK(!e.camera.vertical_fov);
  CHECK((e.film.width == 640 && e.film.height == 360 && e.film.exposure == 0));
  CHECK(e.film.tone == ToneCurve::None);
  CHECK((e.settings.spp == 16 && e.settings.rr_depth == 10 && e.settings.tile == 16 && e.settings.seed == 0));
  CHECK(!e.settings.far);
  CHECK((e.settings.sampler == SamplerKind::Blue && e.film.filter == FilterKind::Box && !e.film.filter_width));
  CHECK((!e.camera.focal_length && !e.camera.lens_radius && !e.camera.f_stop && !e.camera.focus_distance));
  CHECK(e.background.top == glm::dvec3(0));
  REQUIRE(e.materials.size() == 1);
  CHECK(e.materials[0].type == Material::Type::Diffuse);
  CHECK(e.materials[0].color == glm::dvec3(0.8));
}

TEST_CASE("the table's defaults are those of the structs", "[frontend][elaborate]") {
  // A scene without the record has the struct's defaults, and a scene with an empty record has the table's. These
  // defaults must agree.
  CHECK(film_record().find("width")->fallback[0] == Film().width);
  CHECK(film_record().find("height")->fallback[0] == Film().height);
  CHECK(film_record().find("exposure")->fallback[0] == Film().exposure);
  CHECK(render_record().find("spp")->fallback[0] == RenderSettings().spp);
  CHECK(render_record().find("rr_depth")->fallback[0] == RenderSettings().rr_depth);
  CHECK(render_record().find("tile")->fallback[0] == RenderSettings().tile);
  CHECK(camera_records()[0].find("sensor_width")->fallback[0] == Camera().sensor_width);
  CHECK(camera_records()[1].find("width")->fallback[0] == Camera().width);
  CHECK(camera_records()[0].find("position")->fallback[2] == Camera().position.z);
  CHECK(material_records()[0].find("color")->fallback[0] == Material().color.x);
  CHECK(material_records()[3].find("ior")->fallback[0] == Material().ior);
}

TEST_CASE("lights and skies are read", "[frontend][elaborate]") {
  const ElaboratedScene e = of_objects(R"({"type": "sphere", "radius": 1})", R"(,
      "background": {"type": "sky", "elevation": 30, "azimuth": 90, "turbidity": 5, "ground_albedo": [0.1, 0.2, 0.3],
                     "strength": 2, "sun_disc": false},
      "lights": {"bulb": {"type": "point", "position": [1, 2, 3], "intensity": [4, 5, 6]},
                 "desk": {"type": "spot", "position": [0, 2, 0], "target": [0, 0, 2], "angle": 20, "blend": 0.25},
                 "noon": {"type": "directional"},
                 "dusk": {"type": "directional", "toward": [0, 0, 2], "irradiance": [3, 2, 1], "angle": 1}})");
  const Background::Sky& sky = e.background.sky;
  CHECK(e.background.type == Background::Type::Sky);
  CHECK(glm::length(sky.sun - glm::dvec3(0, 0.5, -std::sqrt(0.75))) < 1e-15);
  CHECK((sky.turbidity == 5 && sky.strength == 2 && !sky.sun_disc && sky.ground_albedo == glm::dvec3(0.1, 0.2, 0.3)));
  REQUIRE(e.lights.size() == 4);
  CHECK((e.lights[0].name == "bulb" && e.lights[0].type == Light::Type::Point));
  CHECK((e.lights[0].position == glm::dvec3(1, 2, 3) && e.lights[0].intensity == glm::dvec3(4, 5, 6)));
  CHECK(glm::length(e.lights[1].direction - glm::dvec3(0, -1, 1) / std::sqrt(2.0)) < 1e-15);
  CHECK((e.lights[1].angle == 20 && e.lights[1].blend == 0.25));
  CHECK((e.lights[2].direction == glm::dvec3(0, -1, 0) && e.lights[2].intensity == glm::dvec3(1)));
  CHECK((e.lights[3].direction == glm::dvec3(0, 0, -1) && e.lights[3].intensity == glm::dvec3(3, 2, 1)));
  const auto& sky_row = background_records()[1];
  CHECK(sky_row.find("turbidity")->fallback[0] == Background::Sky().turbidity);
  CHECK(sky_row.find("ground_albedo")->fallback[0] == Background::Sky().ground_albedo.x);
  CHECK(sky_row.find("strength")->fallback[0] == Background::Sky().strength);
}

TEST_CASE("settings are read", "[frontend][elaborate]") {
  const ElaboratedScene e = of_objects(R"({"type": "sphere", "radius": 1})", R"(,
      "$schema": 5,
      "camera": {"position": [1, 2, 3], "target": [4, 5, 6], "up": [0, 0, 1], "fov_y": 90},
      "film": {"width": 65535, "height": 1, "exposure": -1.5, "tone": "agx"},
      "render": {"spp": 1048576, "rr_depth": 0, "tile": 1024, "seed": 9007199254740991, "far": 100,
                 "noise_threshold": 0.25},
      "background": {"top": [0.5, 0.7, 1]})");
  CHECK(e.camera.position == glm::dvec3(1, 2, 3));
  CHECK(e.camera.target == glm::dvec3(4, 5, 6));
  CHECK(e.camera.up == glm::dvec3(0, 0, 1));
  CHECK(e.camera.vertical_fov.value() == Approx(std::numbers::pi / 2));
  CHECK((e.film.width == 65535 && e.film.height == 1 && e.film.exposure == -1.5));
  CHECK(e.film.tone == ToneCurve::Agx);
  CHECK((e.settings.spp == 1048576 && e.settings.rr_depth == 0 && e.settings.tile == 1024));
  CHECK(e.settings.seed == 9007199254740991u);
  CHECK(e.settings.far.value() == 100);
  CHECK(e.settings.noise_threshold == 0.25);
  CHECK(e.background.bottom == glm::dvec3(0));
  CHECK(e.background.top == glm::dvec3(0.5, 0.7, 1));
  const ElaboratedScene o =
      of_objects(R"({"type": "sphere", "radius": 1})",
                 R"(, "camera": {"type": "orthographic", "width": 7}, "background": [1, 2, 3])");
  CHECK(o.camera.projection == Camera::Projection::Orthographic);
  CHECK(o.camera.width == 7);
  CHECK_FALSE(o.settings.noise_threshold);
  CHECK(o.background.bottom == glm::dvec3(1, 2, 3));
  CHECK(o.background.top == glm::dvec3(1, 2, 3));
}

TEST_CASE("lenses, panoramas, filters and samplers are read", "[frontend][elaborate]") {
  const std::string ball = R"({"type": "sphere", "radius": 1})";
  const ElaboratedScene e = of_objects(ball, R"(,
      "camera": {"position": [0, 0, 5], "focal_length": 50, "sensor_width": 24, "f_stop": 1.4, "focus": [7, 2, 1],
                 "blades": 6, "blade_rotation": 90},
      "film": {"filter": "mitchell", "filter_width": 3.5}, "render": {"sampler": "independent"})");
  CHECK((e.camera.focal_length == 50.0 && e.camera.sensor_width == 24 && e.camera.f_stop == 1.4));
  CHECK(e.camera.focus_distance.value() == 4);  // measured along the view direction
  CHECK((e.camera.blades == 6 && e.camera.blade_rotation == Approx(std::numbers::pi / 2)));
  CHECK((e.film.filter == FilterKind::Mitchell && e.film.filter_width == 3.5));
  CHECK(e.settings.sampler == SamplerKind::Independent);
  const ElaboratedScene o = of_objects(ball, R"(, "camera": {"lens_radius": 0.2, "focus_distance": 3})");
  CHECK((o.camera.lens_radius == 0.2 && o.camera.focus_distance == 3.0 && !o.camera.f_stop));
  CHECK(of_objects(ball, R"(, "camera": {"type": "panorama"})").camera.projection == Camera::Projection::Panorama);
}

TEST_CASE("materials are read", "[frontend][elaborate]") {
  const ElaboratedScene e = of_objects(R"({"type": "sphere", "radius": 1})", R"(, "materials": {
      "a": {"type": "diffuse", "color": [0.1, 0.2, 0.3]},
      "b": {"type": "emissive", "emission": [4, 5, 6]},
      "c": {"type": "specular"},
      "d": {"type": "transparent", "ior": 1.3, "absorption": [0, 0.1, 0.2]}})");
  REQUIRE(e.materials.size() == 5);
  CHECK(e.materials[0].color == glm::dvec3(0.1, 0.2, 0.3));
  CHECK(e.materials[1].type == Material::Type::Emissive);
  CHECK(e.materials[1].emission == glm::dvec3(4, 5, 6));
  CHECK(e.materials[1].color == glm::dvec3(0));
  CHECK(e.materials[2].type == Material::Type::Specular);
  CHECK(e.materials[2].color == glm::dvec3(1));
  CHECK(e.materials[3].type == Material::Type::Transparent);
  CHECK(e.materials[3].ior == 1.3);
  CHECK(e.materials[3].absorption == glm::dvec3(0, 0.1, 0.2));
}

TEST_CASE("equal nodes are one, whatever they are called", "[frontend][elaborate]") {
  const ElaboratedScene e =
      of_objects(R"({"type": "union", "of": [{"use": "a"}, {"use": "b"}, {"type": "sphere", "radius": 1}]})",
                 R"(, "nodes": {"a": {"type": "sphere", "radius": 1}, "b": {"use": "a"}})");
  CHECK(listing(e) == "%0 = sphere radius=1\n%1 = union %0 %0 %0\n%2 = paint surface=0 %1\n");
}

TEST_CASE("parameters stand in the node table's order", "[frontend][elaborate]") {
  CHECK(
      listing(of_objects(R"({"thickness": 0.5, "c": [0, 1, 0], "a": [0, 0, 0], "type": "triangle", "b": [1, 0, 0]})"))
          .starts_with("%0 = triangle a=[0,0,0] b=[1,0,0] c=[0,1,0] thickness=0.5\n"));
  CHECK(listing(of_objects(R"({"type": "smooth_union", "k": 0, "of": [{"type": "sphere", "radius": 1}]})"))
            .find("smooth_union k=0 %0") != std::string::npos);
}

TEST_CASE("materials: the inner one wins, and each object has surfaces of its own", "[frontend][elaborate]") {
  const ElaboratedScene e = of_objects(R"({"name": "pair", "material": "red", "type": "union", "of": [
        {"type": "sphere", "radius": 1}, {"type": "sphere", "radius": 2, "material": "blue"}]},
      {"use": "ball", "material": "red"}, {"use": "ball"})",
                                       kRedBlue + R"(, "nodes": {"ball": {"type": "sphere", "radius": 3}})");
  CHECK(listing(e) ==
        "%0 = sphere radius=1\n"
        "%1 = sphere radius=2\n"
        "%2 = paint surface=0 %1\n"
        "%3 = union %0 %2\n"
        "%4 = paint surface=1 %3\n"
        "%5 = sphere radius=3\n"
        "%6 = paint surface=2 %5\n"
        "%7 = paint surface=3 %5\n"
        "%8 = union %4 %6 %7\n");
  CHECK(surfaces(e) == "pair:blue pair:red ball:red ball 2:default ");
}

TEST_CASE("a definition's own material beats the one of its use", "[frontend][elaborate]") {
  const ElaboratedScene e =
      of_objects(R"({"use": "ball", "material": "red"})",
                 kRedBlue + R"(, "nodes": {"ball": {"type": "sphere", "radius": 1, "material": "blue"}})");
  CHECK(listing(e) == "%0 = sphere radius=1\n%1 = paint surface=0 %0\n");
  CHECK(surfaces(e) == "ball:blue ");
}

TEST_CASE("no paint around what is painted throughout, none twice", "[frontend][elaborate]") {
  const ElaboratedScene e = of_objects(R"({"type": "union", "of": [
      {"type": "sphere", "radius": 1, "material": "red"},
      {"type": "onion", "thickness": 1, "of": {"type": "sphere", "radius": 2, "material": "blue"}}]})",
                                       kRedBlue);
  CHECK(listing(e) ==
        "%0 = sphere radius=1\n"
        "%1 = paint surface=0 %0\n"
        "%2 = sphere radius=2\n"
        "%3 = paint surface=1 %2\n"
        "%4 = onion thickness=1 %3\n"
        "%5 = union %1 %4\n");
  CHECK(surfaces(e) == "union:red union:blue ");
  const ElaboratedScene same = of_objects(R"({"material": "red", "type": "union", "of": [
      {"type": "sphere", "radius": 1, "material": "red"}, {"type": "sphere", "radius": 2}]})",
                                          kRedBlue);
  CHECK(listing(same) == "%0 = sphere radius=1\n%1 = sphere radius=2\n%2 = union %0 %1\n%3 = paint surface=0 %2\n");
}

TEST_CASE("paint lies outside the transform of its node", "[frontend][elaborate]") {
  CHECK(listing(of_objects(R"({"type": "sphere", "radius": 1, "translate": [1, 2, 3]})")) ==
        "%0 = sphere radius=1\n"
        "%1 = transform rows=[1,0,0,-1,0,1,0,-2,0,0,1,-3] factor=1 %0\n"
        "%2 = paint surface=0 %1\n");
}

TEST_CASE("names of objects are unique", "[frontend][elaborate]") {
  const std::string ball = R"({"type": "sphere", "radius": 1})";
  const ElaboratedScene e =
      of_objects(ball + "," + ball + R"(, {"name": "sphere 3", "type": "sphere", "radius": 1},)" + ball +
                 R"(, {"name": "sphere", "type": "sphere", "radius": 1})");
  CHECK(surfaces(e) == "sphere:default sphere 2:default sphere 3:default sphere 4:default sphere 5:default ");
}

TEST_CASE("quarter turns are exact", "[frontend][elaborate]") {
  const auto rows = [](const std::string& placement) {
    const std::string text = listing(of_objects(R"({"type": "sphere", "radius": 1, )" + placement + "}"));
    const std::size_t begin = text.find("rows=");
    return text.substr(begin, text.find(" %0", begin) - begin);
  };
  CHECK(rows(R"("rotate": [0, 90, 0])") == "rows=[0,0,-1,0,0,1,0,0,1,0,0,0] factor=1");
  CHECK(rows(R"("rotate": [90, 0, 0])") == "rows=[1,0,0,0,0,0,1,0,0,-1,0,0] factor=1");
  CHECK(rows(R"("rotate": [0, 0, -270])") == "rows=[0,1,0,0,-1,0,0,0,0,0,1,0] factor=1");
  CHECK(rows(R"("rotate": [180, 360, 720])") == "rows=[1,0,0,0,0,-1,0,0,0,0,-1,0] factor=1");
  CHECK(rows(R"("rotate": {"axis": [0, 7, 0], "angle": 90})") == "rows=[0,0,-1,0,0,1,0,0,1,0,0,0] factor=1");
  CHECK(rows(R"("scale": 2)") == "rows=[0.5,0,0,0,0,0.5,0,0,0,0,0.5,0] factor=2");
  CHECK(rows(R"("scale": [2, 4, 8], "translate": [2, 4, 8])") ==
        "rows=[0.5,0,0,-1,0,0.25,0,-1,0,0,0.125,-1] factor=2");
  CHECK(rows(R"("rotate": {"axis": [1e-200, 0, 0], "angle": 180})") == "rows=[1,0,0,0,0,-1,0,0,0,0,-1,0] factor=1");
}

TEST_CASE("the transform undoes scale, then rotate, then translate", "[frontend][elaborate]") {
  const glm::dvec3 scale(0.5, 2, 3), angles(20, -35, 110), move(1, -2, 0.5);
  const auto params = transform_params(scale, rotation_xyz(angles), move);
  CHECK(params[12] == 0.5);
  const auto turn = [](glm::dvec3 p, int axis, double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    const int y = (axis + 1) % 3, z = (axis + 2) % 3;
    glm::dvec3 q = p;
    q[y] = std::cos(a) * p[y] - std::sin(a) * p[z];
    q[z] = std::sin(a) * p[y] + std::cos(a) * p[z];
    return q;
  };
  for (const glm::dvec3 p : {glm::dvec3(1, 0, 0), glm::dvec3(0.3, -0.7, 2), glm::dvec3(-5, 4, 0.1)}) {
    const glm::dvec3 world = turn(turn(turn(p * scale, 0, angles.x), 1, angles.y), 2, angles.z) + move;
    for (std::size_t i = 0; i < 3; ++i) {
      const double back =
          params[4 * i] * world.x + params[4 * i + 1] * world.y + params[4 * i + 2] * world.z + params[4 * i + 3];
      CHECK(back == Approx(p[static_cast<int>(i)]).margin(1e-12));
    }
  }
  // Rotation about an axis: the axis stays fixed, and the rest turns counter-clockwise as seen with the axis pointing
  // at the viewer.
  const glm::dmat3 r = rotation_about({1, 1, 1}, 120);
  CHECK(glm::length(r * glm::dvec3(1, 0, 0) - glm::dvec3(0, 1, 0)) < 1e-15);
  CHECK(glm::length(r * glm::dvec3(1, 1, 1) - glm::dvec3(1, 1, 1)) < 1e-15);
}

TEST_CASE("forty doublings take linear time and space", "[frontend][elaborate]") {
  for (const bool painted : {false, true}) {
    std::string nodes =
        fmt::format(R"("a0": {{"type": "sphere", "radius": 1{}}})", painted ? R"(, "material": "red")" : "");
    for (int i = 1; i <= 40; ++i) {
      nodes += fmt::format(
          R"(, "a{0}": {{"type": "union", "of": [{{"use": "a{1}"}}, {{"use": "a{1}", "translate": [{0}, 0, 0], "material": "blue"}}]}})",
          i, i - 1);
    }
    const ElaboratedScene e =
        of_objects(R"({"use": "a40"}, {"use": "a40"})", kRedBlue + R"(, "nodes": {)" + nodes + "}");
    CHECK(e.scene.graph.size() < 40 * 2 * 8);
  }
}

TEST_CASE("deep nesting and long chains of names elaborate", "[frontend][elaborate]") {
  // Each `onion` adds one level of JSON, each `union` two.
  const auto nested = [](int depth, const std::string& open, const std::string& close) {
    std::string text;
    for (int i = 0; i < depth; ++i) text += open;
    text += R"({"type": "sphere", "radius": 1})";
    for (int i = 0; i < depth; ++i) text += close;
    return text;
  };
  CHECK(of_objects(nested(1000, R"({"type": "union", "of": [)", "]}")).scene.graph.size() == 1002);
  CHECK(of_objects(nested(4000, R"({"type": "onion", "thickness": 1, "of": )", "}")).scene.graph.size() == 4002);

  std::string chain = R"("a0": {"type": "sphere", "radius": 1, "material": "red"})";
  const int length = scaled_cases(100000);
  for (int i = 1; i <= length; ++i) chain += fmt::format(R"(, "a{}": {{"use": "a{}"}})", i, i - 1);
  const ElaboratedScene e =
      of_objects(fmt::format(R"({{"use": "a{}"}})", length), kRedBlue + R"(, "nodes": {)" + chain + "}");
  CHECK(e.scene.graph.size() == 2);
}

TEST_CASE("a long cycle is found without deep recursion", "[frontend][elaborate]") {
  std::string text = R"({"version": 1, "objects": [{"use": "a0"}], "nodes": {)";
  const int length = scaled_cases(100000);
  for (int i = 0; i < length; ++i)
    text += fmt::format(R"({}"a{}": {{"use": "a{}"}})", i ? "," : "", i, (i + 1) % length);
  const Source source("scene.json", text + "}}");
  Diagnostics diagnostics;
  const auto file = read_json(source, diagnostics);
  REQUIRE(file.has_value());
  CHECK(!elaborate(*file, diagnostics));
  REQUIRE(diagnostics.errors() == 1);
  CHECK(diagnostics.all()[0].code == "E0204");
  CHECK(diagnostics.all()[0].message.size() < 200);
}

TEST_CASE("every synonym leads to the right word", "[frontend][elaborate]") {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"type": "subtract"})", "`subtraction`"},
      {R"({"type": "difference"})", "`subtraction`"},
      {R"({"type": "cube"})", "`box`"},
      {R"({"type": "sphere", "r": 1})", "`radius`"},
      {R"({"type": "sphere", "radius": 1, "pos": 1})", "`translate`"},
      {R"({"type": "union", "children": []})", "`of`"},
      {R"({"type": "box", "size": 1})", "`half_size`"},
  };
  for (const auto& [object, meant] : cases) {
    const Source source("scene.json", fmt::format(R"({{"version": 1, "objects": [{}]}})", object));
    Diagnostics diagnostics;
    const auto file = read_json(source, diagnostics);
    REQUIRE(file.has_value());
    CHECK(!elaborate(*file, diagnostics));
    CHECK(diagnostics.print(source, ErrorFormat::Text).find(fmt::format("did you mean {}?", meant)) !=
          std::string::npos);
  }
}

TEST_CASE("records name every property once", "[frontend][elaborate]") {
  std::vector<const RecordSpec*> records = {&scene_record(),    &film_record(), &render_record(),
                                            &rotation_record(), &use_record(),  &parameter_record()};
  for (const RecordSpec& r : light_records()) records.push_back(&r);
  for (const RecordSpec& r : background_records()) records.push_back(&r);
  for (const RecordSpec& r : camera_records()) records.push_back(&r);
  for (const RecordSpec& r : material_records()) records.push_back(&r);
  for (const RecordSpec& r : pattern_records()) records.push_back(&r);
  for (const NodeSpec& node : node_table()) records.push_back(&node_record(node.kind));
  for (const RecordSpec* r : records) {
    for (const PropertySpec& p : r->properties) {
      CAPTURE(r->title, std::string(p.name));
      CHECK(r->find(p.name) == &p);
      CHECK(!p.doc.empty());
    }
  }
}

}  // namespace

}  // namespace fathom::elaborate_test
